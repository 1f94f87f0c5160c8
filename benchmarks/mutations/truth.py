"""What is true of a certificate's claim, by the physics and an independent search: no verifier, no proof."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from benchmarks.soundness.search import best_value, ground_of
from nullpose.channel import PointChannels, excess_gain
from nullpose.objectives import Quantity
from nullpose.physics import Pose, Reception, objective_value
from nullpose.problem.family import still_scenes
from nullpose.scenario import Scenario
from nullpose.scenario.polygon import depth_m

Data = dict[str, Any]

_STARTS, _STARTS_HELD = (
    200,
    50,
)  # random walks of a search; of a pose at several instants, each of which counts
_ROUNDING = 1e-9


class Problem:
    """A scenario's ratios and borders, put together plainly from physics and scenario."""

    def __init__(self, scenario: Scenario) -> None:
        self.scenario, airspace = scenario, scenario.airspace
        nodes, jammers = scenario.node_positions_m, scenario.jammer_positions_m.reshape(-1, 3)
        gain = scenario.receiver.reference_gain
        if scenario.objective == "secrecy-rate":
            others, last = scenario.eavesdropper_positions_m, jammers
            sent = gain * scenario.transmitter.transmit_power_w
            self.isotropic = 1.0
            self.above = np.repeat(sent / scenario.node_noise_w, len(others))
            self.node = np.repeat(np.arange(len(nodes)), len(others))
            self.below = np.tile(np.diag(sent / scenario.eavesdropper_noise_w), (len(nodes), 1))
        else:
            others, last = jammers, jammers[:0]
            scale = gain / scenario.receiver.noise_power_w
            self.isotropic = 0.0
            self.above = scale * scenario.node_powers_w / scenario.node_required_sinr
            self.node = np.arange(len(nodes))
            self.below = np.tile(scale * scenario.jammer_powers_w, (len(nodes), 1))
        self.first, self.points = len(nodes), np.vstack([nodes, others, last])
        hearers = scenario.eavesdroppers if scenario.objective == "secrecy-rate" else scenario.jammers
        antennas = [*scenario.nodes, *hearers, *scenario.jammers][: len(self.points)]
        halved = np.array([0.5 if one.antenna == "circular" else 1.0 for one in antennas])
        self.above = self.above * halved[: self.first][self.node]
        self.below = self.below * halved[self.first : self.first + self.below.shape[1]]
        axes = [one.antenna_axis or (0.0, 0.0, 1.0) for one in antennas]
        self.axes = np.array([np.array(axis) / np.linalg.norm(axis) for axis in axes])
        self.is_dipole = np.array([one.antenna == "dipole" for one in antennas])
        self.leak = getattr(scenario.antenna_record, "leak", 0.0)  # forms are of dipoles
        heard = (
            scenario.eavesdropper_channels
            if scenario.objective == "secrecy-rate"
            else (scenario.jammer_channels)
        )
        self.channels = (scenario.node_channels, heard)
        nearest = np.clip(self.points, airspace.lower_m, airspace.upper_m)
        self.balls = self.points[np.linalg.norm(self.points - nearest, axis=1) < airspace.keep_out_m]
        self.zones = [
            zone.depth_m
            for zone in airspace.no_fly
            if zone.floor_m < airspace.upper_m[2] and zone.ceiling_m > airspace.lower_m[2]
        ]
        if airspace.geofence_m is not None:
            self.zones.append(lambda p: -depth_m(p[..., :2], airspace.geofence_outline_m))

    def gains(self, to_points_m: np.ndarray) -> np.ndarray:
        """Return the links' power gains over free space, (..., points)."""
        parts = np.split(to_points_m, [self.first, self.first + self.below.shape[1]], axis=-2)
        channels: tuple[PointChannels | None, ...] = (*self.channels, None)
        each = zip(channels, parts, strict=True)
        return np.concatenate(
            [np.ones(r.shape[:-1]) if c is None else excess_gain(c, r) for c, r in each], axis=-1
        )

    def best_received(self, distance_m: np.ndarray) -> np.ndarray:
        """Return the largest numerators at distances, one for each ratio: no gain is larger than overhead."""
        below = np.zeros((len(self.node), len(self.points), 3))
        below[..., 2] = -distance_m[:, None]
        gains = self.gains(below)[np.arange(len(self.node)), self.node]
        return np.asarray(self.isotropic + self.above * gains / distance_m**2)

    def forms(self, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return numerators and denominators of all ratios at positions, (..., ratios, 3, 3) each."""
        r = self.points - p[..., None, :]
        square = np.sum(r * r, axis=-1)[..., None, None]
        links = np.eye(3) / square - r[..., :, None] * r[..., None, :] / square**2
        own = np.einsum("...mij,mj->...mi", links, self.axes) * np.sqrt(
            square[..., 0]
        )  # paper eq. 1.4, twice
        polarised = own[..., :, None] * own[..., None, :]
        links = np.where(self.is_dipole[:, None, None], polarised, links)
        of_dipole = np.sum(own**2, axis=-1)[..., None, None]
        whole = np.where(self.is_dipole[:, None, None], of_dipole, 1.0 / square)
        links = (1.0 - self.leak) * links + self.leak * whole * np.eye(3)
        links = links * self.gains(r)[..., None, None]
        above = self.isotropic * np.eye(3) + self.above[:, None, None] * links[..., self.node, :, :]
        others = links[..., self.first : self.first + self.below.shape[1], :, :]
        return above, np.eye(3) + np.einsum("ke,...eij->...kij", self.below, others)

    def value(self, pose: Pose) -> float:
        """Return the smallest ratio at a pose."""
        return value_at(self.scenario, pose)


def value_at(scenario: Scenario, pose: Pose) -> float:
    """Return what a certificate's value states of a pose: a ratio, the smallest or the mean."""
    if scenario.time is not None:
        return min(value_at(scene, pose) for scene in still_scenes(scenario))
    received = Reception(scenario, pose.position_m, pose.orientation(scenario.antenna_record))
    if scenario.objective == "sum-rate":
        return float(np.exp(np.average(np.log1p(received.sinr), weights=weights_of(scenario))))
    if scenario.objective == "proportional-fair":
        return float(np.exp(np.average(np.log(received.sinr), weights=weights_of(scenario))))
    if scenario.objective == "friendly-jamming":
        overheard = received.overheard_sinr.max(axis=-1)
        return float(((1.0 + received.jammed_sinr) / (1.0 + overheard)).min())
    if scenario.objective == "secrecy-rate":
        return float((1.0 + received.node_snr.min()) / (1.0 + received.eavesdropper_snr.max()))
    return float(objective_value(scenario, pose.position_m, received.axis))


def weights_of(scenario: Scenario) -> list[float]:
    """Return the weights that nodes have in a sum or a mean."""
    return [1.0 if node.weight is None else node.weight for node in scenario.nodes]


def misses(scenario: Scenario, pose: Pose) -> bool:
    """Check whether a node has less than it requires, where a sum or a mean is maximised."""
    if scenario.objective not in ("sum-rate", "proportional-fair"):
        return False
    if scenario.time is not None:
        return any(misses(scene, pose) for scene in still_scenes(scenario))
    orientation = pose.orientation(scenario.antenna_record)
    required_db = [-np.inf if node.min_sinr_db is None else node.min_sinr_db for node in scenario.nodes]
    with np.errstate(divide="ignore"):
        reached_db = 10.0 * np.log10(Reception(scenario, pose.position_m, orientation).sinr)
    return bool(np.any(reached_db < np.array(required_db) - _ROUNDING))


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


def allowed_axes(data: Data, scenario: Scenario) -> dict[str, Any]:
    """Return the names and axes, functions of the position, that the scheme allows; None is any axis."""
    scenario = scenario.still()  # the axes alone do not move
    jammers = dict(zip(scenario.jammer_names, scenario.jammer_positions_m, strict=True))
    null, band = data["null_jammer"], scenario.axis_band
    if null is not None and data["scheme"] != "zero-interference":
        return {}
    if data["scheme"] == "optimum" and band != (1.0, 1.0):
        return {"free" if band == (0.0, 1.0) else "band": None}
    if data["scheme"] in ("vertical", "optimum"):
        return {"vertical": lambda p: np.array([0.0, 0.0, 1.0])}
    if data["scheme"] == "maximum-gain" and len(scenario.nodes) == 2:
        return {"broadside": lambda p: _unit(np.cross(*(scenario.node_positions_m - p)))}
    if data["scheme"] == "zero-interference":
        return {
            f"null {name}": lambda p, at=at: _unit(at - p)
            for name, at in jammers.items()
            if null in (None, name)
        }
    return {}


def claim_fault(data: Data, scenario: Scenario) -> str:
    """Return what is false of the pose and the two numbers."""
    value, bound = data["value"], data["upper_bound"]
    if not value > 0.0 or bound < value:
        return "bound below the value"
    airframe, pose = scenario.airframe, pose_of(data, scenario)
    if scenario.airspace.clearance_m(pose.position_m) < -2e-9:
        return "pose outside"
    points_m = np.vstack([ground_of(scene) for scene in still_scenes(scenario)])
    if np.min(np.linalg.norm(points_m - pose.position_m, axis=1)) < scenario.airspace.keep_out_m - 1e-6:
        return "pose kept out"
    if airframe is not None and pose.tilt_rad > airframe.tilt_max_rad + 2e-9:
        return "tilt"
    if abs(value_at(scenario, pose) - value) > 1e-9 * value:
        return "value"
    if misses(scenario, pose):
        return "requirement"
    axes = allowed_axes(data, scenario)
    if not axes:
        return "scheme"
    u = pose.antenna_axis
    sines = [0.0 if f is None else np.linalg.norm(np.cross(f(pose.position_m), u)) for f in axes.values()]
    return "axis" if min(sines) > 1e-5 else ""


def pose_of(data: Data, scenario: Scenario) -> Pose:
    """Return the pose that a certificate's data state."""
    airframe = scenario.airframe
    names = ("position_m", "roll_rad", "pitch_rad", "yaw_rad")
    stated = {name: data["pose"][name] for name in names}
    return Pose(**stated, mount_rad=0.0 if airframe is None else airframe.mount_rad)


class Truth:
    """Judges claims, keeping the best value of each scenario; of some, good poses are known before."""

    def __init__(self, optima: list[Data]) -> None:
        self._optima = {self._key(data): data for data in optima}
        self._best: dict[str, float] = {}

    def falsehood(self, data: Data) -> str:
        """Return what is false in a certificate's claim, or nothing if nothing was found."""
        scenario = Scenario.from_dict(data["scenario"])
        fault = claim_fault(data, scenario)
        if fault:
            return fault
        best = self.best(data, scenario)
        if best > data["upper_bound"] * (1.0 + _ROUNDING):
            return f"a pose reaches {best!r}, above the bound"
        return ""

    def best(self, data: Data, scenario: Scenario) -> float:
        """Return the largest smallest ratio that is known of a scenario under a scheme."""
        key = self._key(data)
        if key not in self._best:
            pose = pose_of(self._optima.get(key, data), scenario)
            orientation = pose.orientation(scenario.antenna_record)
            if orientation.ndim == 2:
                orientation = Rotation.from_matrix(orientation).as_quat()
            found = best_value(
                scenario,
                data["scheme"],
                starts=_STARTS if scenario.time is None else _STARTS_HELD,
                seed=len(self._best),
                near=(pose.position_m, orientation),
                null_jammer=data["null_jammer"],
            )
            rates = sum(weights_of(scenario)) if scenario.objective == "sum-rate" else 1.0
            self._best[key] = found if Quantity.of(scenario).unit == "dB" else 2.0 ** (found / rates)
        return self._best[key]

    @staticmethod
    def _key(data: Data) -> str:
        return json.dumps([data["scenario"], data["scheme"], data["null_jammer"]], sort_keys=True)
