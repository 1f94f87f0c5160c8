"""The state of one page. Immutable: every change, of the scene or of a switch, makes another."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Literal, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from nullpose.errors import Fault, ScenarioError
from nullpose.physics import from_db, to_db
from nullpose.report.numbers import MINUS
from nullpose.scenario import GroundPoint, NoFlyZone, Scenario
from nullpose.scenario.motion import is_moving
from nullpose.studio.answer import Answer, Event, Flight, Notice, status_words
from nullpose.studio.case import OPTIMUM, PoseCase, cases_of
from nullpose.studio.field_map import MAPS, FieldMap, Scale
from nullpose.studio.look import scale_range
from nullpose.studio.toml_like import toml_like

Kind = Literal["nodes", "jammers", "eavesdroppers", "destinations", "sources", "no_fly"]
"""A list of the scenario, the last one being that of its airspace."""
Key = tuple[Kind, int]
"""A ground point or a no-fly zone: which list of the scenario it is in, and where there."""

KINDS: tuple[Kind, ...] = ("nodes", "jammers", "eavesdroppers", "destinations", "sources", "no_fly")
_SCENE = ("scenario", "motion", "case", "compared", "text", "opened")
_MOVES = (
    "it moves, so its place follows from the time; change its motion in the file, or open one instant as a "
    "still scene (--at SECONDS)"
)
_ROUND_M = 3  # digits of a metre that a dragged position keeps
_ROUND_DB = 6  # digits of a decibel that a typed power keeps, so that the field has all of them

POWER_DB = (-30.0, 40.0)
"""Range of the strongest jammer's power over the nodes' that a page offers, dB."""

AnyEvent = TypeVar("AnyEvent", bound=Event)


@dataclass(frozen=True, slots=True, kw_only=True)
class State:
    """A scene, what is found for it, and how it is shown.

    Args:
        scenario: the scene; of one in motion, the instant that is shown.
        motion: the scene in motion, or None.
        case: how its pose is chosen.
        compared: a second case to set beside it, or None.
        text: of the file that the scenario is from, which may be out of date; empty without a file.
        opened: how many other scenes were opened before this one.
        version: of the scene; every change of the fields above makes another.
        events: the latest found of each kind and case, of this version or an earlier one.
        selected: the point or zone whose values are shown, or None.
        pointed: the point under the pointer, or None.
        dragged: the point that a hand moves now, or None.
        tool: what the next click on the ground adds or measures; empty for nothing.
        corners_m: (n, 2) of a fence that is being drawn, or of what is measured, metres.
        map_name: the map that is shown, one of ``MAPS``, or any other text for none.
        has_pattern: whether the radiation patterns are shown.
        has_shadows: whether it is shown where buildings hide points from the drone.
        is_presented: whether the panel is folded and the scene turns.
        faults: what of the last change was refused, as HTML.
    """

    scenario: Scenario
    motion: Scenario | None = None
    case: PoseCase = OPTIMUM
    compared: PoseCase | None = None
    text: str = ""
    opened: int = 0
    version: int = 1
    events: Mapping[tuple[type, PoseCase | None], Event] = field(default_factory=dict)
    selected: Key | None = None
    pointed: Key | None = None
    dragged: Key | None = None
    tool: str = ""
    corners_m: tuple[tuple[float, float], ...] = ()
    map_name: str = MAPS[1]
    has_pattern: bool = True
    has_shadows: bool = True
    is_presented: bool = False
    faults: str = ""

    @property
    def scene(self) -> tuple[object, ...]:
        """What is solved, undone and saved; the other fields are only what is shown."""
        return tuple(getattr(self, name) for name in _SCENE)

    def with_scene_of(self, other: State) -> State:
        """Return the state with another one's scene."""
        return replace(self, **{name: getattr(other, name) for name in _SCENE})

    def with_event(self, event: Event) -> State:
        """Return the state with an event in place of the one before of its kind and case."""
        events = {**self.events, (type(event), getattr(event, "case", None)): event}
        if isinstance(event, Answer):
            events.pop((Notice, None), None)
        return replace(self, events=events)

    def latest(self, kind: type[AnyEvent], case: PoseCase | None = None) -> AnyEvent | None:
        """Look up the latest event of a kind, of whatever version; None without one."""
        event = self.events.get((kind, case))
        return event if isinstance(event, kind) else None

    def present(self, kind: type[AnyEvent], case: PoseCase | None = None) -> AnyEvent | None:
        """Look up the event of a kind for the present version of the scene; None without one."""
        event = self.latest(kind, case)
        return event if event is not None and event.version == self.version else None

    def answer(self, case: PoseCase) -> Answer | None:
        """Return the latest answer for a case, of whatever version; see :meth:`current`."""
        return self.latest(Answer, case)

    def current(self, case: PoseCase) -> Answer | None:
        """Return the answer for a case to the present version of the scene, or None."""
        return self.present(Answer, case)

    def status(self, case: PoseCase) -> str:
        """Say how far the solve of a case has come."""
        answer = self.current(case)
        notice = self.present(Notice, case) or (self.latest(Notice) if answer is None else None)
        return status_words(answer) if notice is None else notice.words

    @property
    def is_answered(self) -> bool:
        """Whether each case has an answer to the present version of the scene, or a reason for none."""
        return all(self.current(case) or self.present(Notice, case) for case in self.cases)

    @property
    def field_map(self) -> FieldMap | None:
        """The maps of the present version, or None."""
        return self.present(FieldMap)

    @property
    def flight(self) -> Flight | None:
        """The flight that was planned for the scene in motion as it is now, or None."""
        flight = self.latest(Flight)
        return flight if flight is not None and flight.motion is self.motion else None

    @property
    def scale(self) -> Scale | None:
        """The map that is shown with its colours, or None."""
        maps = self.field_map
        return None if maps is None else maps.scale(self.map_name)

    @property
    def shadowing(self) -> Answer | None:
        """The answer at whose altitude shadows are drawn, or None; the best values have them in their map."""
        has_own_map = self.scale is not None and self.scale.of_value
        is_shown = self.has_shadows and self.scenario.prisms is not None and not has_own_map
        return self.answer(self.case) if is_shown else None

    @property
    def link_range_db(self) -> tuple[float, float]:
        """Ends of the links' colours, dB: around the SINR of all nodes in the cases shown."""
        answers = filter(None, map(self.answer, self.cases))
        return scale_range([link.sinr_db for answer in answers for link in answer.result.links])

    @property
    def cases(self) -> tuple[PoseCase, ...]:
        """The cases to solve, the chosen one first."""
        return (self.case,) if self.compared is None else (self.case, self.compared)

    def points(self) -> Iterator[tuple[Key, GroundPoint]]:
        """Yield every ground point with its key."""
        yield from (
            ((kind, index), point)
            for kind in KINDS[:-1]
            for index, point in enumerate(getattr(self.scenario, kind))
        )

    @property
    def draft(self) -> Scenario:
        """The scenario that is edited and saved: the one in motion, if there is one."""
        return self.scenario if self.motion is None else self.motion

    def members(self, kind: Kind) -> tuple[GroundPoint | NoFlyZone, ...]:
        """Return a list of the scenario, as it is stated."""
        return tuple(getattr(self.draft.airspace if kind == "no_fly" else self.draft, kind))

    def with_members(self, kind: Kind, members: Iterable[GroundPoint | NoFlyZone]) -> State:
        """Return the state with another list in the scenario.

        Raises:
            ScenarioError: the scenario would be faulty.
        """
        update: dict[str, object] = {kind: tuple(members)}
        if kind == "no_fly":
            update = {"airspace": self.draft.airspace.model_copy(update=update)}
        elif kind == "destinations":
            update = {"destination": next(iter(members), None)}
        return self.with_scenario(self.draft.model_copy(update=update))

    def moved(self, key: Key, position_m: ArrayLike) -> State:
        """Return the state with one ground point elsewhere, to a millimetre.

        Raises:
            ScenarioError: the point moves by itself, or the scenario would be faulty.
        """
        self.require_rest(key)
        kind, index = key
        east, north, up = np.round(np.asarray(position_m, dtype=float), _ROUND_M).tolist()
        points = list(self.members(kind))
        points[index] = points[index].model_copy(update={"position_m": (east, north, up)})
        return self.with_members(kind, points)

    def require_rest(self, key: Key) -> None:
        """Do nothing if a point stays in one place in time.

        Raises:
            ScenarioError: it moves, and a place of its own is not stated.
        """
        kind, index = key
        point = self.members(kind)[index]
        if isinstance(point, GroundPoint) and is_moving(point):
            raise ScenarioError([Fault(f"{kind}[{index}].position_m", _MOVES)])

    @property
    def next_s(self) -> float | None:
        """The time of the next instant, seconds; None at the last one, and in a still scene."""
        if self.motion is None or self.scenario.at_s is None:
            return None
        return next(map(float, (times_s := self.motion.instants_s)[times_s > self.scenario.at_s]), None)

    def at_time(self, t_s: float) -> State:
        """Return the state at the instant of the scene in motion that is nearest to a time.

        Args:
            t_s: the time, seconds; without meaning in a still scene, which stays as it is.

        Raises:
            ScenarioError: the points are then where still ones may not be.
        """
        if self.motion is None:
            return self
        instants_s = self.motion.instants_s
        return replace(self, scenario=self.motion.at(float(instants_s[np.abs(instants_s - t_s).argmin()])))

    @property
    def power_db(self) -> float | None:
        """Power of the strongest jammer over that of the strongest transmitter to be heard, dB.

        None without jammers, or if either has no power.
        """
        heard = self.scenario.nodes if self.scenario.transmitter is None else (self.scenario.transmitter,)
        reference_w = max(source.transmit_power_w for source in heard)
        strongest_w = max((jammer.transmit_power_w for jammer in self.scenario.jammers), default=0.0)
        return None if strongest_w <= 0.0 or reference_w <= 0.0 else float(to_db(strongest_w / reference_w))

    def with_power_db(self, power_db: float) -> State:
        """Return the state with all jammers' powers scaled alike, so that the strongest has this one.

        Raises:
            ScenarioError: the scenario would be faulty.
        """
        if (now_db := self.power_db) is None or math.isclose(now_db, power_db, abs_tol=1e-9):
            return self
        by_db = power_db - now_db
        jammers = tuple(  # each in the unit that it is stated in
            jammer.model_copy(
                update={"power_w": float(f"{jammer.transmit_power_w * float(from_db(by_db)):.12g}")}
                if jammer.power_dbm is None
                else {"power_dbm": float(f"{jammer.power_dbm + by_db:.12g}")}
            )
            for jammer in self.draft.jammers
        )
        return self.with_scenario(self.draft.model_copy(update={"jammers": jammers}))

    @property
    def power_text(self) -> str:
        """The power of the strongest jammer in dB as a text, to a millionth; empty without one."""
        return "" if self.power_db is None else f"{round(self.power_db, _ROUND_DB) + 0.0:.9g}"

    def with_power_text(self, text: str) -> State:
        """Return the state with the jamming power that was typed; see :meth:`with_power_db`.

        Raises:
            ScenarioError: it is no number, or out of that range.
        """
        typed, (low_db, high_db) = text.strip().replace(MINUS, "-"), POWER_DB
        if typed == self.power_text:
            return self
        with suppress(ValueError):
            if low_db <= (power_db := round(float(typed), _ROUND_DB)) <= high_db:
                return self.with_power_db(power_db)
        allowed = f"allowed: a number from {low_db:g} to {high_db:g}, as in 12.5 or 1e1"
        words = f"given {typed or 'nothing'}; {allowed}; it stays at {self.power_text or 'none'}"
        raise ScenarioError([Fault("jamming power, dB", words)])

    def with_scenario(self, scenario: Scenario, text: str | None = None) -> State:
        """Return the state of another scenario, the cases kept where they have a meaning for it.

        Args:
            scenario: the new one; of one in motion the time that is shown stays, and is 0 of another scene.
            text: of the file that it is from, which makes it another scene; None for a change of this one.

        Raises:
            ScenarioError: the points are at that time where still ones may not be.
        """
        motion = scenario if scenario.time else None
        scenario = scenario.still(self.scenario.at_s if motion and text is None else None)
        allowed = cases_of(scenario)
        case = self.case if self.case in allowed else allowed[0]
        compared = self.compared if self.compared in allowed and self.compared != case else None
        state = replace(self, scenario=scenario, motion=motion, case=case, compared=compared)
        return state if text is None else replace(state, text=text, opened=self.opened + 1)

    @property
    def written(self) -> State:
        """The state with the text of its file, if it has one, brought up to date."""
        return replace(self, text=self.text and toml_like(self.text, self.draft))

    def with_case(self, case: PoseCase) -> State:
        """Return the state with another case chosen."""
        return replace(self, case=case, compared=None if self.compared == case else self.compared)
