"""Sionna RT as a judge: every link by its own antennas, in an empty scene."""

from __future__ import annotations

import glob
import os
from collections.abc import Iterator
from typing import Any

import numpy as np

from benchmarks.judges.cases import asked
from benchmarks.judges.verdict import Verdict
from nullpose import Pose, Scenario, evaluate
from nullpose.antenna import PatternAntenna
from nullpose.physics import attitude_from_axis

_SPEED_OF_LIGHT = 299_792_458.0
_DIPOLE, _HALF_WAVE = 1.5, 1.643  # largest gains of Sionna's dipoles over an isotropic antenna
_ALLOWED = 1e-4
_DEEP = 1e-4  # of an un-nulled link: beyond single precision
_TABLE_STEPS = 3600  # from pole to pole


def verdicts() -> Iterator[Verdict]:
    """Yield what Sionna RT says of every kind of antennas."""
    try:
        engine = _Engine()
    except Exception as error:  # it cannot be installed everywhere: LLVM, the processor, the platform
        yield Verdict("Sionna RT", "SINR", 0, None, _ALLOWED, reason=str(error).splitlines()[0][:200])
        return
    found: dict[str, list[float]] = {}
    for name, scenario, poses in asked():
        theirs = engine.sinr(scenario, poses)
        for pose, row in zip(poses, theirs, strict=True):
            ours = np.array([link.sinr for link in evaluate(scenario, pose)])
            away = np.sum((scenario.node_positions_m - pose.position_m) ** 2, axis=1)
            unnulled = scenario.node_powers_w / away / scenario.receiver.noise_power_w
            deviation = np.abs(ours - row) / np.maximum(ours, _DEEP * unnulled)
            found.setdefault(name, []).extend(deviation.tolist())
    for name, deviations in found.items():
        yield Verdict(engine.name, name, len(deviations), max(deviations), _ALLOWED)


def library() -> str | None:
    """Return the newest LLVM on this machine, or None."""
    every = glob.glob("/usr/lib/*/libLLVM*.so*") + glob.glob("/usr/lib/llvm-*/lib/libLLVM*.so*")
    return max(every, key=_version, default=None)


def _version(path: str) -> int:
    digits = "".join(c if c.isdigit() else " " for c in os.path.basename(path)).split()
    return int(digits[0]) if digits else 0


class _Engine:
    """Scenes of Sionna RT in which path gains are one over the squared distance."""

    def __init__(self) -> None:
        found = library()
        if found is None:
            raise RuntimeError("no LLVM; on Debian: apt install libllvm19")
        if _version(found) < 18:  # older ones end the process on some processors
            raise RuntimeError(f"LLVM {_version(found)} is too old; on Debian: apt install libllvm19")
        os.environ.setdefault("DRJIT_LIBLLVM_PATH", found)
        import drjit
        import mitsuba
        import sionna.rt

        self.dr, self.mi, self.rt = drjit, mitsuba, sionna.rt
        self.name = f"Sionna RT {sionna.rt.__version__}"
        self.tables = 0

    def sinr(self, scenario: Scenario, poses: list[Pose]) -> list[np.ndarray]:
        """Return every node's SINR at every pose."""
        points = [*scenario.nodes, *scenario.jammers]
        pattern, peak = self._drone(scenario)
        gains = np.empty((len(poses), len(points)))
        for wired in (False, True):
            some = [i for i, point in enumerate(points) if (point.antenna == "dipole") is wired]
            if some:
                gains[:, some] = self._gains([points[i] for i in some], poses, pattern, wired) / peak
        shares = np.array([0.5 if point.antenna == "circular" else 1.0 for point in points])
        powers = np.concatenate([scenario.node_powers_w, scenario.jammer_powers_w])
        received = gains * shares * powers
        count = len(scenario.nodes)
        noise = np.sum(received[:, count:], axis=1, keepdims=True) + scenario.receiver.noise_power_w
        return list(received[:, :count] / noise)

    def _gains(self, points: list[Any], poses: list[Pose], pattern: str, wired: bool) -> np.ndarray:
        """Return path gains, (poses, points): of both ports together, or of dipoles."""
        rt = self.rt
        one = {"num_rows": 1, "num_cols": 1}
        scene = rt.load_scene()
        scene.frequency = _SPEED_OF_LIGHT / (4.0 * np.pi)
        ports = (
            {"pattern": "dipole", "polarization": "V"} if wired else {"pattern": "iso", "polarization": "VH"}
        )
        scene.tx_array = rt.PlanarArray(**one, **ports)
        scene.rx_array = rt.PlanarArray(**one, pattern=pattern, polarization="V")
        for i, point in enumerate(points):
            turned = [0.0, 0.0, 0.0]
            if wired and point.antenna_axis is not None:
                roll, pitch = attitude_from_axis(point.antenna_axis)
                turned = [0.0, float(pitch), float(roll)]
            scene.add(rt.Transmitter(f"t{i}", [float(x) for x in point.position_m], orientation=turned))
        for k, pose in enumerate(poses):
            angles = [float(pose.yaw_rad), float(pose.pitch_rad), float(pose.roll_rad)]
            scene.add(rt.Receiver(f"r{k}", [float(x) for x in pose.position_m], orientation=angles))
        sight = {"los": True, "specular_reflection": False, "diffuse_reflection": False, "refraction": False}
        real, imaginary = (np.array(part) for part in rt.PathSolver()(scene, max_depth=0, **sight).a)
        power = np.sum(real**2 + imaginary**2, axis=(1, 3, 4))
        return np.asarray(power / (_DIPOLE if wired else 1.0))

    def _drone(self, scenario: Scenario) -> tuple[str, float]:
        """Return the name of the drone's pattern with Sionna, and the gain that counts as 1."""
        antenna = scenario.antenna_record
        if antenna.is_quadratic:
            return "dipole", _DIPOLE
        if antenna.name == "half-wave":
            return "hw_dipole", _HALF_WAVE
        return self._registered(antenna), 1.0

    def _registered(self, antenna: PatternAntenna) -> str:
        """Return the name under which a pattern is registered, as a table of its amplitude."""
        mi, steps = self.mi, _TABLE_STEPS
        theta, phi = (np.arange(steps) + 0.5) * 180.0 / steps, (np.arange(2 * steps) + 0.5) * 180.0 / steps
        gain = antenna.harmonics.on_grid(np.radians(theta), np.radians(phi))
        amplitude = np.sqrt(np.maximum(0.0, gain)).astype(np.float32)[..., None]
        texture = mi.Texture2f(mi.TensorXf(amplitude))

        def pattern(theta_rad: Any, phi_rad: Any) -> Any:
            turn = phi_rad / (2.0 * np.pi)
            where = mi.Point2f(turn - self.dr.floor(turn), theta_rad / np.pi)
            return mi.Complex2f(texture.eval(where)[0], 0.0), mi.Complex2f(0.0, 0.0)

        class Table(self.rt.AntennaPattern):  # type: ignore[misc, name-defined]
            def __init__(self) -> None:
                super().__init__()
                self.patterns = [pattern]

        self.tables += 1
        name = f"table{self.tables}"
        self.rt.register_antenna_pattern(name, lambda **_: Table())
        return name
