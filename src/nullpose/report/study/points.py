"""The combinations of swept values in words, and which of them a report shows."""

from __future__ import annotations

import re
from dataclasses import dataclass

from nullpose.report.numbers import axis_label, unit_of
from nullpose.scenario.units import power_w
from nullpose.study.monte_carlo import StudySpec

MOST_SHOWN = 6  # combinations that have a panel or a column; the tables on disk have all

_JAMMING = re.compile(r"jammers(\.[^.\[\]]+|\[0\])?\.power_w")


@dataclass(frozen=True, slots=True)
class SweptPoints:
    """The combinations of swept values of a study, in words.

    A single jammer's power over that of nodes that all send with the same is written P_M/P, as in the paper.

    Args:
        spec: the study.
        node_power_w: power of every node, if the ratio is to be written; 0 if not.
    """

    spec: StudySpec
    node_power_w: float

    @classmethod
    def of(cls, spec: StudySpec) -> SweptPoints:
        """Return the combinations of a study.

        Args:
            spec: the study.
        """
        return cls(spec, _node_power_w(spec) if _has_one_jammer(spec) else 0.0)

    @property
    def shown(self) -> tuple[int, ...]:
        """Numbers of the combinations that are shown: all, or a few from the first to the last."""
        count = len(self.spec.points)
        if count <= MOST_SHOWN:
            return tuple(range(count))
        return tuple(sorted({round(step * (count - 1) / (MOST_SHOWN - 1)) for step in range(MOST_SHOWN)}))

    @property
    def longest(self) -> str:
        """The path with most values, against which curves are drawn; empty if nothing is swept."""
        return max(self.spec.sweep, key=lambda axis: len(axis[1]))[0] if self.spec.sweep else ""

    @property
    def along(self) -> tuple[int, ...]:
        """Numbers of the combinations along the longest path, with the last values of all others."""
        last, longest = self.spec.points[-1], self.longest
        return tuple(
            number
            for number, values in enumerate(self.spec.points)
            if all(values[path] == last[path] for path in values if path != longest)
        )

    def number(self, point: int, path: str) -> float:
        """Return a swept value as it is written: as P_M/P where that is what it is.

        Args:
            point: the combination's number.
            path: one of the swept paths.
        """
        value = self.spec.points[point][path]
        return value / self.node_power_w if self._is_ratio(path) else value

    def words(self, point: int) -> str:
        """Return a combination in words, as in "P_M/P = 100"; empty if nothing is swept.

        Args:
            point: the combination's number.
        """
        told = []
        for path in self.spec.swept:
            name, unit = ("P_M/P", "") if self._is_ratio(path) else (path, unit_of(path))
            told.append(f"{name} = {self.number(point, path):.6g} {unit}".rstrip())
        return ", ".join(told)

    def axis_label(self, path: str) -> str:
        """Return what an axis of a swept path is labelled.

        Args:
            path: one of the swept paths.
        """
        return r"$P_M / P$  (jammer's power over a node's)" if self._is_ratio(path) else axis_label(path)

    def _is_ratio(self, path: str) -> bool:
        return self.node_power_w > 0.0 and _JAMMING.fullmatch(path) is not None


def _has_one_jammer(spec: StudySpec) -> bool:
    if spec.jammers is not None:
        return not spec.jammers.may_be_several and spec.jammers.count == (1, 1)
    return all(len(scene.jammers) == 1 for scene in spec.scene.scenarios or (spec.scene,))


def _node_power_w(spec: StudySpec) -> float:
    """Return the power that every node of every scene sends with; 0 if they differ or it is not stated."""
    if any(path.startswith("nodes") for path in spec.swept):
        return 0.0
    if spec.nodes is not None:
        watts, dbm = spec.nodes.power_w, spec.nodes.power_dbm
        return power_w(None if watts is None else watts.fixed, None if dbm is None else dbm.fixed) or 0.0
    scenes = spec.scene.scenarios or (spec.scene,)
    powers = {node.transmit_power_w for scene in scenes for node in scene.nodes}
    return powers.pop() if len(powers) == 1 else 0.0
