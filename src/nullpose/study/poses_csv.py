"""Poses as a table of comma-separated values: metres as in the files of sweeps, or places on the Earth."""

from __future__ import annotations

import csv
import io
import math
import os
from collections.abc import Mapping, Sequence
from itertools import islice
from pathlib import Path

import numpy as np

from nullpose.errors import Fault, ScenarioError, UsageError, checked
from nullpose.physics import Poses
from nullpose.scenario.faults import call_each, described, raise_all, refusal, require
from nullpose.scenario.origin import Origin
from nullpose.scenario.toml_file import FileKind, file_text
from nullpose.scenario.units import ALTITUDE_KEYS

_LOCAL, _ANGLES = ("x_m", "y_m", "z_m"), ("roll_deg", "pitch_deg", "yaw_deg")
_NO_ORIGIN = "lat_deg and lon_deg need the [origin] of a scenario; add it, or give x_m, y_m and z_m"
_KIND = FileKind("a file of poses", "poses.csv", (".csv",))


@checked
def poses_from_csv(
    path: str | os.PathLike[str], mount_rad: float = 0.0, origin: Origin | None = None
) -> Poses:
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
        rows = csv.DictReader(io.StringIO(file_text(Path(path), _KIND), newline=""), skipinitialspace=True)
        header = rows.fieldnames or ()
        altitude = next((key for key in ALTITUDE_KEYS if key in header), ALTITUDE_KEYS[0])
        earthly = "x_m" not in header and ("lat_deg" in header or "lon_deg" in header)
        columns = (*(("lat_deg", "lon_deg", altitude) if earthly else _LOCAL), *_ANGLES)
        absent = [name for name in columns[:-1] if name not in header]
        faults = [f"there is no column {name}, must be {', '.join(columns)}" for name in absent]
        faults += [_NO_ORIGIN] if earthly and origin is None else []
        raise_all([Fault("line 1", message) for message in faults])
        place = origin if earthly else None
        numbers, wrong = call_each(lambda row: _numbers(row, f"line {rows.line_num}", columns, place), rows)
        raise_all(wrong)
        require(numbers, "", "there is no line below the header, must be one for each pose")
    except csv.Error as error:
        raise refusal("", f"this is not CSV: {error}; check the quotes", str(path)) from None
    except ScenarioError as error:
        raise ScenarioError(error.faults, str(path)) from None
    table = np.array(numbers)
    roll, pitch, yaw = np.radians(table[:, 3:].T)
    return Poses(table[:, :3], roll, pitch, yaw, mount_rad)


def _numbers(
    row: Mapping[str, str | None], line: str, columns: Sequence[str], origin: Origin | None
) -> list[float]:
    """Read a line's metres and degrees; a place on the Earth from an origin.

    Raises:
        ScenarioError: with every fault of the line.
    """
    texts = {name: row.get(name, "0") for name in columns}
    found = {name: _number(text) for name, text in texts.items()}
    wrong = [name for name, number in found.items() if not math.isfinite(number)]
    raise_all(
        [Fault(f"{line}, column {name}", f"got {described(texts[name])}, must be a number") for name in wrong]
    )
    place, angles_deg = dict(islice(found.items(), 3)), [found[name] for name in _ANGLES]
    try:
        return [*(place.values() if origin is None else origin.position_m(place).tolist()), *angles_deg]
    except UsageError as error:
        raise refusal(line, str(error)) from None


def _number(text: str | None) -> float:
    try:
        return float(text or "")
    except ValueError:
        return math.nan
