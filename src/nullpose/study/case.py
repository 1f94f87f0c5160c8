"""A case: one way of solving a scene, by a scheme, a vehicle or its antennas; and the usual vehicles."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import product
from typing import Annotated, TypeAlias, TypeVar

from pydantic import BeforeValidator, Field

from nullpose.problem.schemes import RECORDS, Scheme
from nullpose.scenario import Airframe, Array, Scenario
from nullpose.scenario.airframe import PRESET_TILTS_DEG
from nullpose.scenario.faults import Place, described, key_faults, require_value
from nullpose.scenario.motion import FLIGHT_KEYS
from nullpose.scenario.rules import ByName, Choice, Count, Limits
from nullpose.scenario.section import Section, optional
from nullpose.scenario.units import Label
from nullpose.scenario.ways import at_most_one
from nullpose.study.evaluation import FixedPose

OMNIDIRECTIONAL = "omnidirectional"  # the case that other vehicles are compared with
FILE_VEHICLE = "stated"  # the case of the scenario's own vehicle, if it is none of the others

TILTS_DEG, _MOUNTS_DEG = (0, 10, 20, 30), {"vertical": 0.0, "horizontal": 90.0}
_AIRFRAMES = {
    f"{f'tilt-{tilt_deg}' if tilt_deg else 'level'}-{dipole}": Airframe(
        tilt_max_deg=tilt_deg, mount_deg=mount_deg
    )
    for tilt_deg, (dipole, mount_deg) in product(TILTS_DEG, _MOUNTS_DEG.items())
} | {OMNIDIRECTIONAL: Airframe(tilt_max_deg=180.0)}
"""The vehicles of every comparison, by the tilt that they take; every tilt with either mount."""
LEVEL = "level-vertical"  # the case that studies compare others with

SHARE = 0.99
"""Of the omnidirectional value: what suffices for the least tilt, unless another share is stated."""
Gap = Annotated[float, Limits("a relative gap", 1e-8, 10.0, "1e-3 is a tenth of a per cent")]
Seconds = Annotated[float, Limits("a time in s", 1e-3, 1e7, "of one solve")]
NodeLimit = Annotated[int, Count("a number of boxes", 1, 1e15, "of one proof")]


_VEHICLE = ByName(
    "a table with tilt_max_deg and mount_deg, or a name",
    {preset: Airframe(preset=preset) for preset in PRESET_TILTS_DEG} | _AIRFRAMES,
)
_POSE = ByName("a table with position_m, or a name", {"centroid": {"position_m": "centroid"}})


def _truth(value: object) -> bool:
    require_value(isinstance(value, bool), f"got {described(value)}, must be true or false, without quotes")
    return bool(value)


_FLIGHTS = {"hover": "the hover", "trajectory": "the best flight"}
_Bool = Annotated[bool, BeforeValidator(_truth)]


class Case(
    Section,
    header="a case, in a table of its own headed [[cases]]",
    letter="C",
    ways=(
        at_most_one("airframe", "array"),
        at_most_one("scheme", "robust", "array", "pose", "reach", "flight"),
        at_most_one("mount_scenes", "reach"),
    ),
):
    """One way of solving a scene.

    Args:
        name: what tables and figures call it.
        scheme: how the pose is chosen.
        airframe: the vehicle in place of the scene's.
        mount_scenes: how many scenes choose the mount of the airframe; None for the mount that it states.
        reach: the share of what any pose reaches for which the least tilt is found; None for the tilt that
            the airframe states.
        array: several dipoles in place of the one.
        robust: whether the pose that guarantees most under the scene's errors is asked for.
        pose: a pose to evaluate, in place of a search.
        flight: what is asked for in a scene in motion: hover or trajectory; None for a pose at t = 0.
        certify: whether to prove anything.
        gap: relative gap in place of the study's.
        time_limit_s: seconds of one solve in place of the study's.
    """

    name: Label = Field(
        default="",
        description="What tables and figures call it. Left out: C1, C2, ... by its place in the file.",
        examples=["tilt-10-horizontal"],
    )
    scheme: Annotated[Scheme, Choice("a scheme", RECORDS)] | None = optional(
        f"How the pose is chosen. Left out: {Scheme.OPTIMUM.value}.", Scheme.VERTICAL.value
    )
    airframe: Annotated[Airframe, _VEHICLE] | None = optional(
        "The vehicle in place of the scene's: level-vertical, level-horizontal, "
        "tilt-10-horizontal (or 20 or 30, or vertical), omnidirectional, a preset, or a table with "
        "tilt_max_deg, which may be least, and mount_deg, which may be best.",
        "tilt-10-horizontal",
    )
    mount_scenes: Annotated[int, Count("a number of scenes", 1, 1e6, "more take longer")] | None = optional(
        'With mount_deg = "best": number of scenes that choose the mount. Left out: 64.', 64
    )
    reach: Annotated[float, Limits("a share", 1e-6, 1.0, "0.99 is all but a hundredth")] | None = optional(
        'With tilt_max_deg = "least": the share of the omnidirectional vehicle\'s bound that '
        f"suffices. Left out: {SHARE}.",
        SHARE,
    )
    array: Array | None = optional(
        "An array on a level vehicle: elements, layout and spacing_wavelengths.",
        {"elements": 4, "layout": "linear", "spacing_wavelengths": 0.5},
    )
    robust: _Bool | None = optional("True: the pose that guarantees most under the scene's errors.", True)
    pose: Annotated[FixedPose, _POSE] | None = optional(
        "A pose to evaluate in every scene, with nothing searched or proved: a table, or centroid.",
        {"position_m": [0.0, 25.0, 8.0], "roll_deg": 90.0},
    )
    flight: Annotated[str, Choice("a flight", tuple(_FLIGHTS))] | None = optional(
        "Of a scene in motion: hover, the one pose whose smallest value over all instants is largest, or "
        "trajectory, the flight within airframe.speed_max_m_s of which it is. Left out: a pose for t = 0.",
        "trajectory",
    )
    certify: _Bool | None = optional("False: search only, and prove nothing.", False)
    gap: Gap | None = optional("Relative gap of this case, in place of the study's.", 1e-2)
    time_limit_s: Seconds | None = optional(
        "Seconds of one solve of this case, in place of the study's.", 30.0
    )

    @classmethod
    def completed(cls, data: Mapping[str, object]) -> Mapping[str, object]:
        """Drop ``robust = false``; add the share of a least tilt, and how many scenes choose a best mount."""
        if isinstance(vehicle := data.get("airframe"), Mapping) and vehicle.get("tilt_max_deg") == "least":
            vehicle = {**vehicle, "tilt_max_deg": 180.0}
            data = {"reach": SHARE, **data, "airframe": vehicle}
        if isinstance(vehicle, Mapping) and vehicle.get("mount_deg") == "best":
            data = {"mount_scenes": 64, **data, "airframe": {**vehicle, "mount_deg": 0.0}}
        return {key: value for key, value in data.items() if not (key == "robust" and value is False)}

    def faults(self, raw: Mapping[str, object]) -> Iterable[tuple[Place, str]]:
        """Yield keys of a proof where there is none."""
        if raw.get("airframe") is None:
            message = "has no meaning without airframe; add one with "
            yield from key_faults(raw, ("mount_scenes",), f'{message}mount_deg = "best"')
            yield from key_faults(raw, ("reach",), f'{message}tilt_max_deg = "least"')
        yield from key_faults(
            raw,
            ("certify", "gap", "time_limit_s") if self.pose is not None else (),
            "has no meaning with a pose, of which nothing is proved; remove it",
        )
        yield from key_faults(
            raw,
            ("certify", "mount_scenes") if self.flight == "trajectory" else (),
            "has no meaning with a trajectory, which always has a bound; remove it",
        )

    @property
    def is_free(self) -> bool:
        """Whether it is the pose of a vehicle with one dipole that is best, or guarantees most."""
        others = (self.array, self.pose, self.reach, self.flight)
        return self.scheme in (None, Scheme.OPTIMUM) and not any(others)

    @property
    def usual(self) -> str:
        """The name of the usual vehicle whose pose it is, by the axes that it reaches; empty if none."""
        if self.scheme is Scheme.VERTICAL:
            return LEVEL
        band = self.airframe.axis_band if self.airframe is not None and self.is_free else None
        return next((name for name, usual in _AIRFRAMES.items() if usual.axis_band == band), "")

    @property
    def is_level(self) -> bool:
        """Whether it is the best pose of a vehicle with one dipole that does not tilt."""
        is_still = self.airframe is not None and self.airframe.tilt_max_rad <= 0.0
        return self.scheme is Scheme.VERTICAL or (self.is_free and is_still)

    @property
    def label(self) -> str:
        """Its name in a table, as in "tilt 10, horizontal"."""
        if self.array is not None:
            return f"array of {self.array.elements}, digital"
        if self.name == FILE_VEHICLE and self.airframe is not None:
            return f"file: tilt {degrees_text(self.airframe.tilt_max_rad)}, mount {self.airframe.mount_deg:g}"
        if self.scheme is not None:
            return self.scheme.label
        level_or_tilt, _, dipole = self.name.rpartition("-")
        mount = f"best ({self.airframe.mount_deg:.4g}°)" if dipole == "best" and self.airframe else dipole
        is_usual = dipole in (*_MOUNTS_DEG, "best")
        return f"{level_or_tilt.replace('-', ' ')}, {mount}" if is_usual else self.name

    @property
    def phrase(self) -> str:
        """What it is in a sentence, as in "a 10 degree tilt with a horizontal dipole"."""
        if self.flight is not None and self.airframe is not None:
            return f"{_FLIGHTS[self.flight]} of {self.model_copy(update={'flight': None}).phrase}"
        if self.pose is not None:
            return f"the given pose {self.name}"
        if self.array is not None:
            return f"a level vehicle with an array of {self.array.elements} with digital combining"
        if self.scheme is not None and self.scheme not in (Scheme.OPTIMUM, Scheme.VERTICAL):
            return f"the {self.scheme.label.lower()} pose"
        if self.airframe is None and not self.usual:
            return f"the case {self.name}"
        phrase, airframe = f"an {OMNIDIRECTIONAL} vehicle", _AIRFRAMES.get(self.usual, self.airframe)
        if airframe is not None and self.usual != OMNIDIRECTIONAL:
            tilt, mount_deg = degrees_text(airframe.tilt_max_rad), airframe.mount_deg
            dipole = {usual_deg: f"a {word} dipole" for word, usual_deg in _MOUNTS_DEG.items()}.get(
                mount_deg, f"the dipole mounted at {mount_deg:.4g} degrees"
            )
            vehicle = "a level vehicle" if tilt == "0" else f"a {tilt} degree tilt"
            if self.reach is not None:
                vehicle = f"the least tilt for {100.0 * self.reach:.6g} %"
            phrase = f"{vehicle} with {dipole}"
        phrase = f"the file's vehicle ({phrase})" if self.name == FILE_VEHICLE else phrase
        chosen = f" (the best mount tried, on up to {self.mount_scenes} scenes)" if self.mount_scenes else ""
        return f"{phrase}{chosen}{' in its robust pose' if self.robust else ''}"

    def mounted(self, mount_deg: float, **changes: object) -> Case:
        """Return the case with its airframe's dipole at another mount.

        Args:
            mount_deg: of the airframe that the case states.
            changes: of the case, by key.
        """
        return self.model_copy(
            update={"airframe": {**self.to_dict()["airframe"], "mount_deg": mount_deg}, **changes}
        )

    def on(self, scenario: Scenario) -> Scenario:
        """Put this case's vehicle into a scenario; an array of the scenario's goes.

        The vehicle keeps the scenario's speed, start and end unless it states others.
        """
        changes: dict[str, object] = {"array": self.array}
        if self.airframe is not None or self.array is not None:
            of_scene = {key: getattr(scenario.airframe, key, None) for key in FLIGHT_KEYS}
            flown = {key: getattr(self.airframe, key, None) or value for key, value in of_scene.items()}
            changes["airframe"] = self.airframe and self.airframe.model_copy(update=flown)
        return scenario.model_copy(update=changes)

    def drawn(self, scene: Scenario) -> Scenario:
        """Put this case's vehicle into a scene of a study: in motion for flights, and else as at t = 0."""
        return self.on(scene if self.flight else scene.still())


AIRFRAME_CASES: tuple[Case, ...] = tuple(
    Case(name=name, airframe=airframe) for name, airframe in _AIRFRAMES.items()
)


def degrees_text(angle_rad: float) -> str:
    """Write an angle in degrees, without digits that are rounding.

    Args:
        angle_rad: the angle, radians.

    Example:
        >>> degrees_text(0.5235987755982988)
        '30'
    """
    return f"{round(math.degrees(angle_rad), 6):g}"


OnProgress: TypeAlias = Callable[[int, int], None] | None
"""Called with how many steps are done and how many there are; None where nobody waits."""
Step = TypeVar("Step")


def report_steps(steps: Sequence[Step], on_progress: OnProgress) -> Iterator[Step]:
    """Yield steps of work, and report each once the next one is asked for."""
    for done, step in enumerate(steps, start=1):
        yield step
        if on_progress is not None:
            on_progress(done, len(steps))
