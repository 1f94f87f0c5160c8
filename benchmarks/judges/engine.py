"""Sionna RT: every link by its own antennas, past buildings as meshes."""

from __future__ import annotations

import glob
import os
from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely

from nullpose import Pose, Scenario
from nullpose.antenna import PatternAntenna
from nullpose.physics import attitude_from_axis
from nullpose.scenario.buildings import Building
from nullpose.studio.drawing import Mesh, merged, prism_mesh

_SPEED_OF_LIGHT = 299_792_458.0
_DIPOLE, _HALF_WAVE = 1.5, 1.643  # largest gains of Sionna's dipoles over an isotropic antenna
_ELEMENT = {"num_rows": 1, "num_cols": 1}
_TABLE_STEPS = 3600  # from pole to pole
_BELOW_GROUND_M = -1.0  # deep enough for ground points, and not so deep that single precision suffers


def library() -> str | None:
    """Return the newest LLVM on this machine, or None."""
    every = glob.glob("/usr/lib/*/libLLVM*.so*") + glob.glob("/usr/lib/llvm-*/lib/libLLVM*.so*")
    return max(every, key=_version, default=None)


def _version(path: str) -> int:
    digits = "".join(c if c.isdigit() else " " for c in os.path.basename(path)).split()
    return int(digits[0]) if digits else 0


def closed_mesh(building: Building, roof_m: float) -> Mesh:
    """Return walls, roof and floor of a building of this height."""
    area_m = shapely.Polygon(building.outline_m, building.courtyard_outlines_m)
    floor_m = max(building.floor_m, _BELOW_GROUND_M)
    return prism_mesh(area_m, floor_m, roof_m)


class Engine:
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

    def gains(self, scenario: Scenario, poses: list[Pose]) -> np.ndarray:
        """Return the gains of the links of nodes, then jammers, at every pose; 0 where one is blocked."""
        points = [*scenario.nodes, *scenario.jammers]
        pattern, peak = self._drone(scenario)
        gains = np.empty((len(poses), len(points)))
        kinds = [(point.antenna == "dipole", point.is_interferer) for point in points]
        for kind in set(kinds):
            places = [place for place, other in enumerate(kinds) if other == kind]
            scene = self._scene(scenario.buildings, *kind)
            scene.rx_array = self.rt.PlanarArray(**_ELEMENT, pattern=pattern, polarization="V")
            gains[:, places] = self._gains(scene, [points[place] for place in places], poses, kind[0]) / peak
        return gains * [0.5 if point.antenna == "circular" else 1.0 for point in points]

    def _scene(self, buildings: Sequence[Building], wired: bool, is_interferer: bool) -> Any:
        """Return a scene with buildings, of the lower roofs for interferers, and the points' antennas."""
        scene = self.rt.load_scene()
        scene.frequency = _SPEED_OF_LIGHT / (4.0 * np.pi)
        ports = (
            {"pattern": "dipole", "polarization": "V"} if wired else {"pattern": "iso", "polarization": "VH"}
        )
        scene.tx_array = self.rt.PlanarArray(**_ELEMENT, **ports)
        if buildings:
            roofs_m = [building.heights_m[0 if is_interferer else 1] for building in buildings]
            scene.edit(add=self._solid(merged(map(closed_mesh, buildings, roofs_m))))
        return scene

    def _solid(self, mesh: Mesh) -> Any:
        shape = self.mi.Mesh("buildings", len(mesh.vertices), len(mesh.faces))
        values = self.mi.traverse(shape)
        values["vertex_positions"] = self.mi.Float(mesh.vertices.ravel())
        values["faces"] = self.mi.UInt32(mesh.faces.ravel())
        values.update()
        wall = self.rt.RadioMaterial("wall", relative_permittivity=3.0)
        return self.rt.SceneObject(mi_mesh=shape, name="buildings", radio_material=wall)

    def _gains(self, scene: Any, points: list[Any], poses: list[Pose], wired: bool) -> np.ndarray:
        """Return path gains, (poses, points): of both ports together, or of dipoles."""
        rt = self.rt
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
