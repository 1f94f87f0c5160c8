"""The table that a sweep fills: one row per value and scheme."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from types import MappingProxyType
from typing import Any

from nullpose.files import write_csv
from nullpose.notebook import html_table, imported
from nullpose.objectives import RECORDS, USUAL, Quantity
from nullpose.solver import Result


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class SweepRow(Result):
    """What was found for one scheme at one value of a setting.

    Args:
        value: the swept setting, in the unit of its name.
    """

    value: float

    @classmethod
    def of(cls, value: float, result: Result) -> SweepRow:
        """Return the row of what was found at a value.

        Args:
            value: the swept setting.
            result: of a solve there.
        """
        return cls(value=value, **{one.name: getattr(result, one.name) for one in fields(result)})

    @property
    def min_sinr(self) -> float:
        """The smallest SINR over the nodes, a power ratio; a node's SNR where the drone transmits."""
        if self.objective.quantity == _SINR:
            return self.objective.value
        return min(link.sinr for link in self.links)

    @property
    def min_sinr_db(self) -> float:
        """The same, dB."""
        return _SINR.in_unit(self.min_sinr)

    @property
    def upper_bound_db(self) -> float | None:
        """No pose exceeds this, dB; None for a rate, or if nothing is proved."""
        quantity, bound = self.objective.quantity, self.objective.upper_bound
        return None if bound is None or quantity.is_rate else quantity.in_unit(bound)

    def to_dict(self) -> dict[str, Any]:
        """Return the row as plain data, angles in radians."""
        objective = self.objective
        return {
            "value": self.value,
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
            "pose": self.pose.to_dict(),
            "links": [link.to_dict() for link in self.links],
            "note": self.note,
        }


@dataclass(frozen=True, slots=True, repr=False)
class SweepTable:
    """What a sweep found.

    Args:
        path: the setting that was swept, as in ``jammers.M.power_w``.
        rows: by value, then by scheme, in the order they were asked for.
        left_out: schemes that do not apply to the scenario, each with the reason.
    """

    path: str
    rows: tuple[SweepRow, ...]
    left_out: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))

    @property
    def values(self) -> tuple[float, ...]:
        """The swept values, each once, in order."""
        return tuple(dict.fromkeys(row.value for row in self.rows))

    @property
    def schemes(self) -> tuple[str, ...]:
        """The schemes, each once, in order."""
        return tuple(dict.fromkeys(row.scheme for row in self.rows))

    def of(self, scheme: str) -> tuple[SweepRow, ...]:
        """Return the rows of one scheme, in the order of the values.

        Args:
            scheme: the scheme's name.

        Raises:
            KeyError: the table has no such scheme.
        """
        rows = tuple(row for row in self.rows if row.scheme == scheme)
        if not rows:
            raise KeyError(f"no scheme {scheme!r} in this table; it has {', '.join(self.schemes)}")
        return rows

    def to_dict(self) -> dict[str, object]:
        """Return the table as plain data."""
        return {
            "set": self.path,
            "rows": [row.to_dict() for row in self.rows],
            "left_out": [{"scheme": scheme, "reason": reason} for scheme, reason in self.left_out.items()],
        }

    def write_csv(self, path: Path) -> Path:
        """Return the path of a CSV file after writing the table to it, units in the column names.

        Args:
            path: the file to write; an existing one is replaced.

        Raises:
            OutputError: the file cannot be written.
        """
        records = self._records()
        heading = list(records[0]) if records else [self.path]
        return write_csv(path, [heading, *([_text(cell) for cell in record.values()] for record in records)])

    def frame(self) -> Any:
        """Return the table as a data frame of pandas with the columns of the CSV file.

        Raises:
            UsageError: pandas is not installed.
        """
        return imported("pandas").DataFrame(self._records())

    def to_xarray(self) -> Any:
        """Return the table's numbers as arrays of xarray over the swept setting and the scheme.

        Raises:
            UsageError: pandas or xarray is not installed.
        """
        imported("xarray")
        return self.frame().set_index([self.path, "scheme"]).to_xarray()

    def __repr__(self) -> str:
        values, cases = self.values, ", ".join(map(str, self.schemes))
        span = f"{values[0]:g} to {values[-1]:g}, " if values else ""
        told = [f"SweepTable({self.path}: {span}{len(values)} values of {cases}", *self._absent()]
        return "; ".join(told) + ")"

    def _repr_html_(self) -> str | None:
        return html_table([{self.path: row.value} | row.row() for row in self.rows])

    def _absent(self) -> list[str]:
        """Return what was left out, with the reasons."""
        return [f"left out: {scheme} ({reason})" for scheme, reason in self.left_out.items()]

    def _records(self) -> list[dict[str, Any]]:
        """Return the rows with every column, numbers as such; None for no number."""
        first = self.rows[:1]
        numbers = _NUMBERS | {
            name: take for row in first for name, take in _own_numbers(row.objective.quantity)
        }
        return [
            {
                self.path: row.value,
                "scheme": str(row.scheme),
                "status": row.status.value,
                "rigour": row.objective.rigour.value,
                **{name: take(row) for name, take in numbers.items()},
                **{f"sinr_{link.node}_db": link.sinr_db for link in row.links},
                "note": row.note,
                "reason": row.reason,
            }
            for row in self.rows
        ]


def _text(cell: object) -> str:
    """Return a cell of a CSV file, a number to its last digit."""
    return "" if cell is None else cell if isinstance(cell, str) else repr(float(cell))  # type: ignore[arg-type]


_Number = Callable[[SweepRow], float | None]

_SINR = RECORDS[USUAL].quantities[0]

# The columns of numbers that every table has.
_NUMBERS: dict[str, _Number] = {
    "min_sinr": lambda row: row.min_sinr,
    "min_sinr_db": lambda row: row.min_sinr_db,
    "upper_bound_db": lambda row: row.upper_bound_db,
    "relative_gap": lambda row: row.objective.relative_gap,
    "x_m": lambda row: row.pose.position_m[0],
    "y_m": lambda row: row.pose.position_m[1],
    "z_m": lambda row: row.pose.position_m[2],
    "roll_deg": lambda row: math.degrees(row.pose.roll_rad),
    "pitch_deg": lambda row: math.degrees(row.pose.pitch_rad),
    "yaw_deg": lambda row: math.degrees(row.pose.yaw_rad),
    "axis_x": lambda row: row.pose.antenna_axis[0],
    "axis_y": lambda row: row.pose.antenna_axis[1],
    "axis_z": lambda row: row.pose.antenna_axis[2],
}


def _own_numbers(quantity: Quantity) -> Iterator[tuple[str, _Number]]:
    """Yield the columns of a quantity other than the SINR."""
    unit = "bps_hz" if quantity.is_rate else "db"
    if quantity != _SINR:
        yield f"{quantity.name}_{unit}", lambda row: quantity.in_unit(row.objective.value)
    if quantity.is_rate:
        yield f"upper_bound_{unit}", lambda row: row.objective.upper_bound
