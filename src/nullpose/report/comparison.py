"""All the paper's cases for one scenario side by side, those that do not apply with their reason."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from nullpose.notebook import html_table
from nullpose.objectives import Quantity
from nullpose.problem.schemes import Scheme
from nullpose.report.certainty import rigour_lines
from nullpose.report.document import View, beside, document, grouped, head, table
from nullpose.report.geometry import null_angle_rad, tilt_rad
from nullpose.report.numbers import bound_text, degrees_text, fixed
from nullpose.report.results import azimuth_text, binding_nodes, work_words
from nullpose.report.words import requirement_words
from nullpose.scenario import Eavesdropper, Jammer, Scenario
from nullpose.solver import Result, compare


@dataclass(frozen=True, slots=True, repr=False)
class Comparison:
    """What each scheme makes of a scenario.

    Args:
        scenario: what was solved.
        solutions: of the schemes that apply, in the paper's order.
        left_out: the other schemes, each with the reason why it does not apply.
    """

    scenario: Scenario
    solutions: tuple[Result, ...]
    left_out: tuple[tuple[Scheme, str], ...]

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C ended a proof."""
        return any(solution.interrupted for solution in self.solutions)

    def __repr__(self) -> str:
        told = [f"Comparison({self.scenario.name!r}: {len(self.solutions)} cases", *self._absent()]
        return "; ".join(told) + ")"

    def _repr_html_(self) -> str:
        return html_table(self.scenario.name, [one.row() for one in self.solutions], self._absent())

    def _absent(self) -> list[str]:
        """Return the cases that do not apply, with the reasons."""
        return [f"left out: {scheme} ({reason})" for scheme, reason in self.left_out]

    def to_dict(self) -> dict[str, object]:
        """Return the comparison as plain data, the scenario once for all cases."""
        found = [solution.to_dict().items() for solution in self.solutions]
        left_out = [
            {"scheme": scheme.value, "status": "not-applicable", "reason": reason}
            for scheme, reason in self.left_out
        ]
        return {
            "scenario": self.scenario.to_dict(),
            "cases": [{key: value for key, value in case if key != "scenario"} for case in found] + left_out,
            "provenance": dict(self.solutions[0].provenance) if self.solutions else {},
        }


def compare_all(scenario: Scenario, **options: Any) -> Comparison:
    """Return the four cases of the paper for one scenario.

    Args:
        scenario: nodes, jammers, receiver and airspace.
        options: of :func:`nullpose.solver.compare`.
    """
    reasons = [(scheme, scheme.not_applicable(scenario)) for scheme in Scheme]
    left_out = tuple((scheme, reason) for scheme, reason in reasons if reason is not None)
    return Comparison(scenario, tuple(compare(scenario, **options)), left_out)


def comparison_view(comparison: Comparison) -> View:
    """Return several schemes' solutions side by side, one column each.

    Args:
        comparison: what each scheme makes of a scenario.
    """
    scenario, quantity = comparison.scenario, Quantity.of(comparison.scenario)
    others = "All cases use one dipole on this file's vehicle. Other vehicles and arrays: compare --airframes"
    bounds = "Each upper bound holds for the poses that its scheme allows."
    return document(
        head(scenario.name),
        table("", _rows(comparison), bold=[f"smallest {quantity.short} ({quantity.unit})"]),
        "\n".join([*_lines(comparison), f"* worst node: the {quantity.smallest} is here", bounds, others]),
    )


def _rows(comparison: Comparison) -> list[Mapping[str, str]]:
    """Return what is told of each scheme, one column each; a rule between values, poses and links."""
    solutions, quantity = comparison.solutions, Quantity.of(comparison.scenario)
    best = max((quantity.in_unit(each.objective.value) for each in solutions), default=math.nan)
    rows: list[Mapping[str, str]] = []
    for cells in (_value_cells, _pose_cells, _link_cells):
        rows += [*beside({each.label: cells(each, best) for each in solutions}), {}]
    return rows


def _lines(comparison: Comparison) -> list[str]:
    """Return what is said of the cases: notes, requirements, what does not apply, how sure each is."""
    solutions = comparison.solutions
    labelled = [(each.label, each) for each in solutions]
    absent = [(scheme.label, f"not applicable: {reason}") for scheme, reason in comparison.left_out]
    starts = sum(each.stats.starts for each in solutions)
    boxes = sum(each.stats.boxes for each in solutions)
    return [
        *grouped((label, each.note) for label, each in labelled),
        *grouped((label, requirement_words(each)) for label, each in labelled),
        *grouped([*absent, *((label, "") for label, _ in labelled)]),
        *grouped(
            (label, f"{each.status.message}{each.reason and f': {each.reason}'}") for label, each in labelled
        ),
        *rigour_lines((label, each.rigour) for label, each in labelled),
        f"{work_words(starts, boxes)} (all cases together)",
    ]


def _value_cells(solution: Result, best: float) -> dict[str, str]:
    objective, quantity = solution.objective, solution.objective.quantity
    value, smallest = quantity.in_unit(objective.value), f"smallest {quantity.short}"
    return {
        f"{smallest} ({quantity.unit})": f"{value:.7f}",
        f"upper bound ({quantity.unit})": bound_text(objective, 7),
        **({} if quantity.is_rate else {smallest: f"{objective.value:.7g}"}),
        f"below the best ({quantity.unit})": fixed(best - value, 4),
    }


def _pose_cells(solution: Result, _: float) -> dict[str, str]:
    """Return place and attitude, and how far the null is off what it is for."""
    scenario, pose = solution.scenario, solution.pose
    points: list[Jammer | Eavesdropper] = [*scenario.eavesdroppers]
    if not solution.objective.quantity.is_rate:
        points += scenario.jammers
    angles = {
        "roll (deg)": pose.roll_rad,
        "pitch (deg)": pose.pitch_rad,
        "yaw (deg)": pose.yaw_rad,
        "vehicle's tilt (deg)": pose.tilt_rad,
        "axis tilt (deg)": tilt_rad(pose),
    }
    return {
        **{f"{axis} (m)": fixed(float(at), 3) for axis, at in zip("xyz", pose.position_m, strict=True)},
        **{name: degrees_text(angle_rad) for name, angle_rad in angles.items()},
        "axis azimuth (deg)": azimuth_text(pose),
        **{f"axis to {p.name} (deg)": degrees_text(null_angle_rad(pose, p.position_m)) for p in points},
    }


def _link_cells(solution: Result, _: float) -> dict[str, str]:
    """Return each node's SINR, margin or rate, and its ratio; a mark where the node binds."""
    quantity, links, binding = solution.objective.quantity, solution.links, binding_nodes(solution)
    ratios = {f"{quantity.ratio} {link.node} (dB)": f"{link.sinr_db:.4f} " for link in links}
    return ratios | {
        f"{quantity.short} {link.node} ({quantity.unit})": (
            f"{quantity.in_unit(quantity.at(link)):.4f}{'*' if link.node in binding else ' '}"
        )
        for link in links
    }
