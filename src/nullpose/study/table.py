"""The table of several solves: one row per case, and per value of a setting where one is swept."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import TYPE_CHECKING

from nullpose.files import PlainTable, write_csv
from nullpose.notebook import html_table, imported
from nullpose.objectives import RECORDS, USUAL
from nullpose.problem.schemes import Scheme
from nullpose.scenario import Scenario
from nullpose.solver import Result
from nullpose.study.case import Case
from nullpose.study.least_tilt import MountTilt

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


_POSE = ("x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg")


@dataclass(frozen=True, slots=True, kw_only=True)
class Guaranteed:
    """What is left of a value under the scenario's errors: power ratios, or bits/s/Hz.

    Args:
        nominal_pose: the value that the pose which is best without errors guarantees; proved.
        robust_pose: the value that the pose which guarantees most does; proved. None after an interrupt.
        upper_bound: no pose of the vehicle guarantees more; None if nothing is proved.
    """

    nominal_pose: float
    robust_pose: float | None
    upper_bound: float | None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class ResultRow(Result):
    """The result of one case, at one value of a setting if one is swept.

    Args:
        value: the swept setting, in the unit of its name; NaN if nothing is swept.
        case: how it was solved.
        guaranteed: what is left under errors; None if the scenario has none.
        tilt: both sides of the least tilt, where that was the question.
    """

    value: float = math.nan
    case: Case
    guaranteed: Guaranteed | None = None
    tilt: MountTilt | None = None

    @classmethod
    def of(
        cls,
        value: float,
        result: Result,
        case: Case | None = None,
        kept: Guaranteed | None = None,
        tilt: MountTilt | None = None,
    ) -> ResultRow:
        """Make a row of a result; without a case the scheme says it."""
        if case is None:
            scheme = Scheme(result.scheme) if result.scheme in tuple(Scheme) else None
            case = Case(name=str(scheme or result.label), scheme=scheme)
        columns = {column.name: getattr(result, column.name) for column in fields(result)}
        return cls(value=value, case=case, guaranteed=kept, tilt=tilt, **columns)

    @property
    def name(self) -> str:
        """The case's name."""
        return self.case.name

    @property
    def label(self) -> str:
        """The name of the case for tables."""
        return self.case.label

    @property
    def min_sinr(self) -> float:
        """The smallest SINR over the nodes, a power ratio; a node's SNR where the drone transmits."""
        is_sinr = self.objective.quantity == _SINR
        return self.objective.value if is_sinr else min(link.sinr for link in self.links)

    @property
    def min_sinr_db(self) -> float:
        """The same, dB."""
        return _SINR.in_unit(self.min_sinr)

    @property
    def upper_bound_db(self) -> float | None:
        """No pose exceeds this, dB; None for a rate, or if nothing is proved."""
        quantity, bound = self.objective.quantity, self.objective.upper_bound
        return None if bound is None or quantity.is_rate else quantity.in_unit(bound)

    @property
    def tilts(self) -> PlainTable:
        """The mount, the share and both sides of the least tilt, as columns; none in other rows."""
        if self.tilt is None:
            return {}
        return {
            "mount_deg": self.tilt.mount_deg,
            "share": self.case.reach,
            "least_tilt_deg": self.tilt.suffices_deg,
            "too_little_deg": self.tilt.fails_deg,
        }

    def record(self) -> PlainTable:
        """List the columns of the row in a file, its case apart; None for no number."""
        columns, axis = self.row(), self.pose.antenna_axis.tolist()
        attitude = {name: columns.pop(name) for name in _POSE}
        del columns["case"], columns["status"], columns["binding_node"]
        numbers = {
            "min_sinr": self.min_sinr,
            "min_sinr_db": self.min_sinr_db,
            "upper_bound_db": self.upper_bound_db,
            "relative_gap": self.objective.relative_gap,
        }
        return {
            **self.tilts,
            "scheme": str(self.scheme),
            "status": self.status.value,
            "rigour": self.objective.rigour.value,
            **(numbers | attitude | dict(zip(("axis_x", "axis_y", "axis_z"), axis, strict=True)) | columns),
            **{f"sinr_{link.node}_db": link.sinr_db for link in self.links},
            "note": self.note,
            "reason": self.reason,
        }

    def to_dict(self) -> PlainTable:
        """Return the row as plain data, angles in radians."""
        objective, guaranteed = self.objective, self.guaranteed
        vehicle = {
            key: section.to_dict()
            for key, section in (("airframe", self.case.airframe), ("array", self.case.array))
            if section is not None and self.tilt is None
        }
        return {
            "case": self.name,
            **({} if math.isnan(self.value) else {"value": self.value}),
            **(vehicle | self.tilts),
            "scheme": str(self.scheme),
            "status": self.status.value,
            "rigour": objective.rigour.value,
            "reason": self.reason,
            "objective": objective.name,
            objective.name: objective.value,
            "min_sinr": self.min_sinr,
            "min_sinr_db": self.min_sinr_db,
            "upper_bound": objective.upper_bound,
            "upper_bound_db": self.upper_bound_db,
            "relative_gap": objective.relative_gap,
            **objective.rates,
            "pose": self.pose.to_dict(),
            "links": [link.to_dict() for link in self.links],
            "binding_node": self.binding_node,
            "stats": {key: value for key, value in asdict(self.stats).items() if value is not None},
            "note": self.note,
            **({} if guaranteed is None else {"guaranteed": asdict(guaranteed)}),
        }


@dataclass(frozen=True, slots=True, repr=False)
class ResultTable:
    """The results of several cases, over the values of a setting if one is swept.

    Args:
        path: the setting that was swept, as in ``jammers.M.power_w``; empty if none was.
        rows: by value, then by case.
        left_out: cases without a result, each with the reason.
        scenario: that every case is about; None of a sweep, whose rows have their own.
        provenance: versions, seed and settings; of a sweep each row has its own.
    """

    path: str
    rows: tuple[ResultRow, ...]
    left_out: Mapping[str, str] = field(default_factory=dict)
    scenario: Scenario | None = None
    provenance: Mapping[str, object] = field(default_factory=dict)

    @property
    def values(self) -> tuple[float, ...]:
        """The swept values, each once, in order."""
        return tuple(dict.fromkeys(row.value for row in self.rows if not math.isnan(row.value)))

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the cases, each once, in order."""
        return tuple(dict.fromkeys(row.name for row in self.rows))

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C ended a proof."""
        return any(row.interrupted for row in self.rows)

    def of(self, name: str) -> tuple[ResultRow, ...]:
        """Return the rows of one case, in the order of the values.

        Args:
            name: of the case: a scheme, or a vehicle such as ``tilt-10-horizontal``.

        Raises:
            KeyError: the table has no such case.
        """
        if not (rows := tuple(row for row in self.rows if row.name == name)):
            raise KeyError(f"no case {name!r} in this table; it has {', '.join(self.names)}")
        return rows

    def to_dict(self) -> PlainTable:
        """Return the table as plain data."""
        whole: PlainTable = {} if self.scenario is None else {"scenario": self.scenario.to_dict()}
        return {
            **whole,
            **({"set": self.path} if self.path else {}),
            "rows": [row.to_dict() for row in self.rows],
            "left_out": [{"case": name, "reason": reason} for name, reason in self.left_out.items()],
            **({"provenance": dict(self.provenance)} if self.provenance else {}),
        }

    def write_csv(self, path: Path) -> Path:
        """Write the table to a CSV file, units in the column names; return its path.

        Args:
            path: the file; an existing one is replaced.

        Raises:
            OutputError: the file cannot be written.
        """
        records = self._records()
        return write_csv(
            path, [list(records[0]) if records else [self.path], *(record.values() for record in records)]
        )

    def frame(self) -> pd.DataFrame:
        """Return the table as a data frame of pandas with the columns of the CSV file.

        Raises:
            UsageError: pandas is not installed.
        """
        return imported("pandas").DataFrame(self._records())

    def to_xarray(self) -> xr.Dataset:
        """Return the table's numbers as arrays of xarray over the swept setting and the scheme or mount.

        Raises:
            UsageError: pandas or xarray is not installed.
        """
        imported("xarray")
        axes = [self.path or "case", "mount_deg" if self.rows[0].tilt else "scheme"]
        return self.frame().set_index(axes).to_xarray()

    def __repr__(self) -> str:
        values = self.values
        span = f"{values[0]:g} to {values[-1]:g}, {len(values)} values of " if values else ""
        title = self.path if self.scenario is None else repr(self.scenario.name)
        names = ", ".join(self.names if len(self.names) < 5 else [*self.names[:4], "..."])
        absent = [f"left out: {name} ({reason})" for name, reason in self.left_out.items()]
        return "; ".join([f"ResultTable({title}: {span}{names}", *absent]) + ")"

    def _repr_html_(self) -> str | None:
        return html_table(
            [({self.path: row.value} if self.path else {}) | row.tilts | row.row() for row in self.rows]
        )

    def _records(self) -> list[PlainTable]:
        """List the rows with every column, numbers as such; None for no number."""
        return [
            {self.path or "case": row.value if self.path else row.label} | row.record() for row in self.rows
        ]


_SINR = RECORDS[USUAL].quantities[0]
