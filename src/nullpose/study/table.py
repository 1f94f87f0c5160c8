"""The table that a sweep fills: one row per value and scheme."""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

from nullpose.physics import Link, Pose, to_db
from nullpose.study.files import replacing

__all__ = ["SweepRow", "SweepTable"]


@dataclass(frozen=True, slots=True)
class SweepRow:
    """The pose found for one value and one scheme.

    Args:
        value: the swept setting, in the unit of its name.
        scheme: the scheme's name, as in ``maximum-gain``.
        status: how sure the solver is, as in ``certified``.
        min_sinr: the smallest SINR over the nodes, a power ratio.
        min_sinr_db: the same, dB.
        pose: where the drone is and how it is turned.
        links: every node's SINR, in the scenario's order.
        note: one sentence that the reader needs beside the numbers, or nothing.
        upper_bound: no pose's smallest SINR exceeds this, a power ratio; None if nothing is proved.
        relative_gap: ``(upper_bound - min_sinr) / min_sinr``; None if nothing is proved.
        reason: what kept the row from being certified; empty if nothing did.
    """

    value: float
    scheme: str
    status: str
    min_sinr: float
    min_sinr_db: float
    pose: Pose
    links: tuple[Link, ...]
    note: str = ""
    upper_bound: float | None = None
    relative_gap: float | None = None
    reason: str = ""

    @property
    def upper_bound_db(self) -> float | None:
        """The upper bound, dB; None if nothing is proved."""
        return None if self.upper_bound is None else float(to_db(self.upper_bound))

    def to_dict(self) -> dict[str, object]:
        """Return the row as plain data, angles in radians."""
        return {
            "value": self.value,
            "scheme": self.scheme,
            "status": self.status,
            "reason": self.reason,
            "min_sinr": self.min_sinr,
            "min_sinr_db": self.min_sinr_db,
            "upper_bound": self.upper_bound,
            "upper_bound_db": self.upper_bound_db,
            "relative_gap": self.relative_gap,
            "pose": {
                "position_m": [float(x) for x in self.pose.position_m],
                "roll_rad": self.pose.roll_rad,
                "pitch_rad": self.pose.pitch_rad,
                "yaw_rad": self.pose.yaw_rad,
                "antenna_axis": [float(x) for x in self.pose.antenna_axis],
            },
            "links": [{"node": link.node, "sinr": link.sinr, "sinr_db": link.sinr_db} for link in self.links],
            "note": self.note,
        }


@dataclass(frozen=True, slots=True)
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

    def joined(self, other: SweepTable) -> SweepTable:
        """Return the rows of this table and of another sweep of the same setting, by ascending value.

        Args:
            other: the other sweep.

        Raises:
            ValueError: the other table is of another setting.
        """
        if other.path != self.path:
            raise ValueError(f"a sweep of {other.path} cannot join one of {self.path}")
        rows = sorted((*self.rows, *other.rows), key=lambda row: row.value)
        left_out = MappingProxyType({**self.left_out, **other.left_out})
        return SweepTable(path=self.path, rows=tuple(rows), left_out=left_out)

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
        nodes = [link.node for link in self.rows[0].links] if self.rows else []
        with replacing(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow([self.path, *_COLUMNS, *(f"sinr_{node}_db" for node in nodes), "note", "reason"])
            writer.writerows(_csv_row(row) for row in self.rows)
        return path


_COLUMNS = (
    "scheme",
    "status",
    "min_sinr",
    "min_sinr_db",
    "upper_bound_db",
    "relative_gap",
    "x_m",
    "y_m",
    "z_m",
    "roll_deg",
    "pitch_deg",
    "yaw_deg",
    "axis_x",
    "axis_y",
    "axis_z",
)


def _csv_row(row: SweepRow) -> list[object]:
    pose = row.pose
    angles_deg = [math.degrees(angle) for angle in (pose.roll_rad, pose.pitch_rad, pose.yaw_rad)]
    proved = (row.upper_bound_db, row.relative_gap)
    numbers = [row.min_sinr, row.min_sinr_db, *proved, *pose.position_m, *angles_deg, *pose.antenna_axis]
    links_db = [link.sinr_db for link in row.links]
    texts = ["" if number is None else repr(float(number)) for number in (*numbers, *links_db)]
    return [repr(float(row.value)), row.scheme, row.status, *texts, row.note, row.reason]
