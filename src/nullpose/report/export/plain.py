"""A pose or a flight as plain numbers: JSON, rows of CSV, and lines of a TUM trajectory."""

from __future__ import annotations

import math
from hashlib import sha256

import numpy as np

from nullpose.certificate.file import certificate_text
from nullpose.files import json_text
from nullpose.physics import FramePose, pose_frames
from nullpose.solver import Result, Rigour
from nullpose.solver.certificate_from_proof import certificate_of
from nullpose.solver.trajectory import Trajectory


def json_file(result: Result) -> bytes:
    """Write a pose as JSON: ENU, body forward-left-up, with its value, bound and certificate's digest."""
    scenario, objective = result.scenario, result.objective
    frames, quantity, bound = pose_frames(scenario, result.pose), objective.quantity, objective.upper_bound
    content = {
        "case": result.label,
        "world_frame": "ENU",
        "body_frame": "FLU",
        "position_m": frames.enu.position_m,
        "quaternion_wxyz": frames.enu.quaternion_wxyz,
        **_angles_deg(frames.enu),
        "mount_deg": math.degrees(result.pose.mount_rad),
        "antenna_axis": result.pose.antenna_axis.tolist(),
        "origin": scenario.origin and scenario.origin.model_dump(exclude_none=True),
        "place": frames.geodetic and frames.geodetic.to_dict(),
        "quantity": quantity.name,
        "unit": quantity.unit,
        "value": quantity.in_unit(objective.value),
        "upper_bound": None if bound is None else quantity.in_unit(bound),
        "status": result.status.value,
        "rigour": result.rigour.value,
        "certificate_sha256": sha256(certificate_text(certificate_of(result)).encode()).hexdigest()
        if result.rigour is Rigour.VERIFIED
        else None,  # as --certificate writes it, uncompressed
    }
    return f"{json_text(content)}\n".encode()


def tum_file(result: Result) -> bytes:
    """Write a pose as a TUM trajectory of one line, ``t x y z qx qy qz qw``, at t = 0."""
    enu = pose_frames(result.scenario, result.pose).enu
    return f"0 {' '.join(map(repr, (*enu.position_m, *enu.quaternion_xyzw)))}\n".encode()


def csv_file(result: Result) -> bytes:
    """Write a pose as a row of CSV: the place on the Earth if there is an origin, metres, attitude."""
    frames = pose_frames(result.scenario, result.pose)
    row = {} if frames.geodetic is None else frames.geodetic.to_dict()
    row |= zip(("x_m", "y_m", "z_m"), frames.enu.position_m, strict=True)
    row |= zip(("qw", "qx", "qy", "qz"), frames.enu.quaternion_wxyz, strict=True)
    row |= _angles_deg(frames.enu)
    return f"{','.join(row)}\n{','.join(map(repr, row.values()))}\n".encode()


def flight_tum_file(flight: Trajectory) -> bytes:
    """Write a flight as a TUM trajectory, a line ``t x y z qx qy qz qw`` for each instant."""
    rows = ((row["time_s"], *row["position_m"], *np.roll(row["wxyz"], -1).tolist()) for row in flight.rows())
    return "".join(f"{' '.join(map(repr, row))}\n" for row in rows).encode()


def flight_csv_file(flight: Trajectory) -> bytes:
    """Write a flight as rows of CSV: time, metres, quaternion, value and the optimum of the instant."""
    names = [f"{name}_{flight.quantity.ending}" for name in ("value", "optimum")]
    heads = ("time_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz", *names)
    rows = ((row["time_s"], *row["position_m"], *row["wxyz"], *map(row.get, names)) for row in flight.rows())
    return "".join(f"{','.join(row)}\n" for row in (heads, *(map(repr, row) for row in rows))).encode()


def _angles_deg(frame: FramePose) -> dict[str, float]:
    return {f"{name}_deg": math.degrees(getattr(frame, f"{name}_rad")) for name in ("roll", "pitch", "yaw")}
