"""The scenario: everything that the user states about one problem."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from nullpose.antenna import SHORT_DIPOLE, AnyAntenna
from nullpose.antenna.from_file import ESTIMATE
from nullpose.errors import UsageError, WrongTypeError, checked, require_usage
from nullpose.files import PlainTable
from nullpose.scenario.airspace import Airspace
from nullpose.scenario.arrays import ScenarioTables
from nullpose.scenario.crosscheck import scenario_faults
from nullpose.scenario.faults import Place, described
from nullpose.scenario.motion import still_at, time_of
from nullpose.scenario.origin import located
from nullpose.scenario.section import Floats, Section
from nullpose.scenario.toml_file import toml_text
from nullpose.scenario.units import ratio_from_db


class Scenario(ScenarioTables):
    """Nodes, jammers, a receiver and an airspace, in one world frame: east, north, up (ENU), in metres.

    Raises:
        ScenarioError: with every fault of the values together.
    """

    @classmethod
    def from_file(cls, path: str | os.PathLike[str], *, allow_outside: bool = False) -> Scenario:
        """Read the scenario that a TOML file describes; the same as ``nullpose.load``."""
        from nullpose.scenario.loading import load

        return load(path, allow_outside=allow_outside)

    @classmethod
    def from_arrays(
        cls,
        nodes_m: ArrayLike,
        jammers_m: ArrayLike = (),
        *,
        node_power_w: ArrayLike | None = None,
        jammer_power_w: ArrayLike | None = None,
        node_power_dbm: ArrayLike | None = None,
        jammer_power_dbm: ArrayLike | None = None,
        noise_w: float | None = None,
        noise_dbm: float | None = None,
        altitude_m: tuple[float, float],
        reference_gain_db: float | None = None,
        frequency_hz: float | None = None,
        **more: object,
    ) -> Scenario:
        """Make the scenario of nodes and jammers that are given as arrays.

        The paper's:
        ``Scenario.from_arrays([[0, 0, 0], [0, 50, 0]], [[17, 15, 4]], noise_w=1e-3, altitude_m=(8, 30))``

        Args:
            nodes_m: positions east, north, up [m], shape (n, 3).
            jammers_m: likewise, (m, 3); none if left out.
            node_power_w: transmit powers [W], (n,) or one for all; 1 if none are given.
            jammer_power_w: likewise, (m,) or one for all.
            node_power_dbm: in place of node_power_w, the same in dBm.
            jammer_power_dbm: likewise.
            noise_w: noise power of the drone's receiver [W]; or else
            noise_dbm: the same in dBm, unless ``receiver`` states it.
            altitude_m: lowest and highest altitude of the vehicle [m].
            reference_gain_db: path gain between isotropic antennas 1 m apart [dB]; or else
            frequency_hz: carrier frequency [Hz], from which it follows. If neither is given, it is 0 dB as in
                the paper, unless ``receiver`` states one.
            more: other keys of a scenario, such as ``name`` or ``airframe``, with their tables; of
                ``airspace`` and ``receiver`` what is not given above.

        Raises:
            UsageError: shapes that do not go together.
            ScenarioError: with every fault of the values.

        Example:
            >>> import nullpose
            >>> nullpose.Scenario.from_arrays(
            ...     [[0, 0, 0], [0, 50, 0]], [[17, 15, 4]], noise_w=1e-3, altitude_m=(8, 30), name="paper"
            ... )
            Scenario('paper': 2 nodes, 1 jammer, min-sinr, altitude 8 to 30 m)
        """
        points = {
            "nodes": _rows_of_points("node", nodes_m, node_power_w, node_power_dbm),
            "jammers": _rows_of_points("jammer", jammers_m, jammer_power_w, jammer_power_dbm),
        }
        receiver = {
            "noise_w": noise_w,
            "noise_dbm": noise_dbm,
            "frequency_hz": frequency_hz,
            "reference_gain_db": reference_gain_db,
        }
        tables: dict[str, dict[str, object]] = {
            "airspace": {"altitude_m": altitude_m},
            "receiver": {key: value for key, value in receiver.items() if value is not None},
        }
        for key, table in tables.items():
            added = more.pop(key, {})
            added = added.to_dict() if isinstance(added, Section) else added
            if not isinstance(added, Mapping):
                raise WrongTypeError(f"{key}: given {described(added)}; allowed: a table of its other keys")
            table |= added
        if not tables["receiver"].keys() & {"frequency_hz", "reference_gain_db"}:
            tables["receiver"]["reference_gain_db"] = 0.0
        return cls.from_dict({**points, **more, **tables})

    @classmethod
    def completed(cls, data: Mapping[str, object]) -> Mapping[str, object]:
        """Fill in the positions of points that are stated by latitude and longitude.

        The name, which every output has, says of an antenna that is an estimate that it is one.
        """
        antenna, name = data.get("antenna"), data.get("name", "")
        if isinstance(antenna, Mapping) and antenna.get("two_cuts") and ESTIMATE not in str(name):
            data = {**data, "name": f"{name} (antenna: {ESTIMATE})".strip()}
        return located(data)

    def faults(self, raw: PlainTable) -> Iterable[tuple[Place, str]]:
        """Return the faults between the parts of the scenario, those that are None being at fault."""
        return scenario_faults(self, raw)

    @checked
    def at(self, t_s: float) -> Scenario:
        """Return the still scene in which everything stands where it is at one instant.

        It says so: ``at_s`` is the time, and the name ends with it. The vehicle's speed, start and end are
        not in it.

        Args:
            t_s: from 0 to the duration of the scene [s]; any time, not only one of ``instants_s``.

        Raises:
            UsageError: nothing moves in the scene, or the time is outside it.
            ScenarioError: the points are then where still ones may not be, as in a building.

        Example:
            >>> import nullpose
            >>> scene = nullpose.load("examples/moving_jammer.toml")
            >>> scene.at(10.0).jammers[0].position_m
            (-20.0, 15.0, 4.0)
            >>> found = nullpose.solve_many([scene.at(t_s) for t_s in scene.instants_s])
            >>> found.value.shape, round(float(found.value.min()), 3)
            ((61, 1), 0.896)
        """
        return still_at(self, t_s)

    def still(self, at_s: float | None = None) -> Scenario:
        """Return the scene at an instant, at 0 unless one is stated; a still scene as it is.

        Args:
            at_s: the time of the instant [s]; None for none stated.

        Raises:
            UsageError: an instant of a still scene is asked for, or one outside the duration.
        """
        return self if self.time is None and at_s is None else self.at(at_s or 0.0)

    @property
    def instant(self) -> PlainTable:
        """The key ``at_s``, for results that state no scenario; nothing of a scene in which nothing moves."""
        return {} if self.at_s is None else {"at_s": self.at_s}

    @property
    def instants_s(self) -> Floats:
        """The times of a scene in motion [s], (n,): 0, step_s and so on to exactly duration_s.

        Raises:
            UsageError: nothing moves in the scene.
        """
        return time_of(self, "instants_s: asked for").instants_s

    def to_toml(self) -> str:
        """Return the text of a scenario file that loads as an equal scenario."""
        return toml_text(self.to_dict())

    def __repr__(self) -> str:
        counts = [
            (len(self.nodes), "node"),
            (len(self.jammers), "jammer"),
            *([(len(self.eavesdroppers), "eavesdropper")] if self.eavesdroppers else ()),
        ]
        numbers = ", ".join(f"{count} {noun}{'s' * (count != 1)}" for count, noun in counts)
        low, high = self.airspace.altitude_m
        span = "" if self.time is None else f", in motion for {self.time.duration_s:g} s"
        return f"Scenario({self.name!r}: {numbers}, {self.objective}, altitude {low:g} to {high:g} m{span})"

    __str__ = __repr__

    @property
    def antenna_record(self) -> AnyAntenna:
        """What the drone's antenna states of itself."""
        return SHORT_DIPOLE if self.antenna is None else self.antenna.record

    @property
    def antenna_gain_dbi(self) -> float:
        """What the gain of the drone's antenna record counts from [dBi], stated as ``gain_dbi``."""
        return 0.0 if self.antenna is None else self.antenna.gain_dbi

    @property
    def without_array(self) -> Scenario:
        """The scenario with one dipole in place of its array."""
        return self if self.array is None else self.model_copy(update={"array": None})

    @property
    def reference_gain(self) -> float:
        """Path gain at 1 m times the largest gain of the drone's antenna, linear."""
        return self.receiver.reference_gain * ratio_from_db(self.antenna_gain_dbi)

    @cached_property
    def open_airspace(self) -> Airspace:
        """The airspace less the buildings, which are no-fly zones in it."""
        return self.airspace.outside(building.zone for building in self.buildings)

    @property
    def has_margins(self) -> bool:
        """Whether any node, or the destination, states a weight or a required SINR."""
        return any(each.weight is not None or each.min_sinr_db is not None for each in self.terminals)

    @property
    def states_antennas(self) -> bool:
        """Whether any antenna has another pattern than the paper's: the drone's, or one on the ground."""
        return self.antenna_record != SHORT_DIPOLE or any(
            point.antenna != "isotropic" for point in self.points
        )

    @property
    def is_uncertain(self) -> bool:
        """Whether any position, or the pose that the vehicle holds, is known only up to an error."""
        return any((self.receiver.attitude_error_deg, self.receiver.position_error_m)) or any(
            point.uncertainty_reach_m > 0.0 for point in (*self.jammers, *self.eavesdroppers)
        )

    @property
    def axis_band(self) -> tuple[float, float]:
        """Least and greatest ``u_z^2`` of the axes that the airframe reaches; (0, 1) for all of them."""
        return (0.0, 1.0) if self.airframe is None else self.airframe.axis_band


def _rows_of_points(
    kind: str, points_m: ArrayLike, power_w: ArrayLike | None, power_dbm: ArrayLike | None
) -> list[dict[str, object]]:
    """Return the tables of points that are given as arrays.

    Args:
        kind: ``"node"`` or ``"jammer"``, for messages.
        points_m: positions east, north, up [m], shape (n, 3), or an empty list.
        power_w: transmit powers [W], shape (n,) or one for all; 1 if neither these are given nor
        power_dbm: the same in dBm.

    Raises:
        UsageError: shapes that do not go together.
    """
    places = _numbers(f"{kind}s_m", points_m)
    require_usage(
        places.size == 0 or places.shape[1:] == (3,),
        f"{kind}s_m: given shape {places.shape}; allowed: (n, 3), a row of east, north and up in metres "
        "for each; try its transpose .T, [[east, north, up]] for one point, or zeros for heights",
    )
    columns = {"position_m": places.reshape(-1, 3)}
    powers = {"power_w": 1.0 if power_w is None and power_dbm is None else power_w, "power_dbm": power_dbm}
    count = len(columns["position_m"])
    for key, values in powers.items():
        if values is not None:
            power = _numbers(f"{kind}_{key}", values)
            require_usage(
                power.shape in ((), (count,)),
                f"{kind}_{key}: given shape {power.shape} with {count} {kind}s; allowed: one number, or "
                f"shape ({count},)",
            )
            columns[key] = np.broadcast_to(power, count)
    return [
        dict(zip(columns, row, strict=True))
        for row in zip(*map(np.ndarray.tolist, columns.values()), strict=True)
    ]


def _numbers(name: str, values: ArrayLike) -> Floats:
    try:
        return np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise UsageError(
            f"{name}: given values that make no array of numbers; allowed: numbers, in rows of equal length"
        ) from None
