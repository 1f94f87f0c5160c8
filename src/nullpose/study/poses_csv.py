"""Poses as a table of comma-separated values: metres as in the files of sweeps, or places on the Earth."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from nullpose.errors import Fault, ScenarioError, UsageError
from nullpose.physics import Poses
from nullpose.scenario.origin import Origin
from nullpose.scenario.toml_file import FileKind, file_text
from nullpose.scenario.units import ALTITUDE_KEYS
from nullpose.scenario.wording import described

_LOCAL, _ANGLES = ("x_m", "y_m", "z_m"), ("roll_deg", "pitch_deg", "yaw_deg")
_NO_ORIGIN = "lat_deg and lon_deg need the [origin] of a scenario; add it, or give x_m, y_m and z_m"
_KIND = FileKind("a file of poses", "poses.csv", (".csv",))


def poses_from_csv(path: Path, mount_rad: float = 0.0, origin: Origin | None = None) -> Poses:
    """Return the poses of a CSV file.

    Args:
        path: a file with the columns ``x_m``, ``y_m``, ``z_m``, ``roll_deg``, ``pitch_deg`` and, unless it is
            zero, ``yaw_deg``; others are passed over, so that the table of a sweep can be read. In place of
            the metres ``lat_deg``, ``lon_deg`` and one of ``alt_m``, ``alt_msl_m`` and ``alt_agl_m``.
        mount_rad: angle of the dipole from the body's vertical, radians.
        origin: of the scenario, which columns in degrees need.

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
        header = rows.fieldnames or ()
        altitude = next((key for key in ALTITUDE_KEYS if key in header), ALTITUDE_KEYS[0])
        earthly = "x_m" not in header and ("lat_deg" in header or "lon_deg" in header)
        columns = (*(("lat_deg", "lon_deg", altitude) if earthly else _LOCAL), *_ANGLES)
        absent = [name for name in columns[:-1] if name not in header]
        message = "there is no column {}, must be " + ", ".join(columns)
        faults = [Fault("line 1", message.format(name)) for name in absent]
        if earthly and origin is None:
            faults.append(Fault("line 1", _NO_ORIGIN))
        numbers = [] if faults else [_numbers(row, rows.line_num, columns, faults, origin) for row in rows]
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


def _numbers(
    row: Mapping[str, str | None],
    line: int,
    columns: Sequence[str],
    faults: list[Fault],
    origin: Origin | None,
) -> list[float]:
    """Return a line's metres and degrees, after noting what is wrong with them."""
    found = []
    for name in columns:
        text = row.get(name, "0")
        try:
            number = float(text or "")
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            faults.append(Fault(f"line {line}, column {name}", f"got {described(text)}, must be a number"))
        found.append(number)
    if columns[:3] != _LOCAL and origin is not None and all(map(math.isfinite, found)):
        try:
            found[:3] = origin.position_m(dict(zip(columns[:3], found, strict=False))).tolist()
        except UsageError as error:
            faults.append(Fault(f"line {line}", str(error)))
    return found
