"""Poses as a table of comma-separated values: metres and degrees, as in the files of sweeps."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from nullpose.errors import Fault, ScenarioError
from nullpose.physics import Poses
from nullpose.scenario.toml_file import FileKind, file_text
from nullpose.scenario.wording import described, listed

_NEEDED = ("x_m", "y_m", "z_m", "roll_deg", "pitch_deg")
_COLUMNS = (*_NEEDED, "yaw_deg")
_KIND = FileKind("a file of poses", "poses.csv", (".csv",))


def poses_from_csv(path: Path, mount_rad: float = 0.0) -> Poses:
    """Return the poses of a CSV file.

    Args:
        path: a file with the columns ``x_m``, ``y_m``, ``z_m``, ``roll_deg``, ``pitch_deg`` and, unless it is
            zero, ``yaw_deg``; others are passed over, so that the table of a sweep can be read.
        mount_rad: angle of the dipole from the body's vertical, radians.

    Raises:
        ScenarioError: with every fault of the file.

    Example:
        >>> import tempfile
        >>> from pathlib import Path
        >>> import nullpose
        >>> table = nullpose.sweep(nullpose.load("examples/paper.toml"), "jammers.M.power_w", [1.0, 10.0])
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     poses = nullpose.poses_from_csv(table.write_csv(Path(folder) / "sweep.csv"))
        >>> len(poses) == len(table.rows)
        True
    """
    try:
        rows = csv.DictReader(io.StringIO(file_text(path, _KIND), newline=""), skipinitialspace=True)
        absent = [name for name in _NEEDED if name not in (rows.fieldnames or ())]
        told = "there is no column {}, must be " + listed(_COLUMNS)
        faults = [Fault("line 1", told.format(name)) for name in absent]
        numbers = [] if absent else [_numbers(row, rows.line_num, faults) for row in rows]
        if not numbers and not faults:
            faults.append(Fault("", "there is no line below the header, must be one for each pose"))
    except csv.Error as error:
        numbers, faults = [], [Fault("", f"this is not CSV: {error}; check the quotes")]
    except ScenarioError as error:
        raise ScenarioError(error.faults, str(path)) from None
    if faults:
        raise ScenarioError(faults, str(path))
    table = np.array(numbers)
    roll, pitch, yaw = np.radians(table[:, 3:].T)
    return Poses(table[:, :3], roll, pitch, yaw, mount_rad)


def _numbers(row: Mapping[str, str | None], line: int, faults: list[Fault]) -> list[float]:
    """Return a line's numbers, after noting what is wrong with them."""
    found = []
    for name in _COLUMNS:
        text = row.get(name, "0")
        try:
            number = float(text or "")
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            faults.append(Fault(f"line {line}, column {name}", f"got {described(text)}, must be a number"))
        found.append(number)
    return found
