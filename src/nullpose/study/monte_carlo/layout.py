"""How the points of one kind are placed: nodes, jammers or eavesdroppers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from pydantic import Field

from nullpose.scenario.faults import Place, rejection
from nullpose.scenario.names import Label
from nullpose.scenario.rules import Choice, Count, Quantity, Rule
from nullpose.scenario.section import Section
from nullpose.scenario.units import (
    DecibelMilliwatts,
    ErrorMetres,
    Metres,
    PlanePoint,
    RadiusMetres,
    Range,
    RatioDecibels,
    Watts,
    Weight,
)
from nullpose.scenario.ways import Ways, at_most_one, exactly_one
from nullpose.scenario.wording import described, plain
from nullpose.study.monte_carlo.distribution import Distribution, Drawn

MOST_POINTS = 10_000  # of one kind in a scene


@dataclass(frozen=True, slots=True)
class _Number(Rule):
    """A whole number, or a range of them that one is drawn from evenly."""

    noun: str
    low: int

    def read(self, value: object) -> tuple[int, int]:
        value = plain(value)
        one = Count(self.noun, self.low, MOST_POINTS, "or a range, as in [2, 10]")
        if not isinstance(value, list | tuple):
            return (one.read(value),) * 2
        if len(value) != 2:
            raise rejection(f"got {described(value)}, must be {self.noun}, or two, the smaller first")
        ends = one.read(value[0]), one.read(value[1])
        if ends[0] > ends[1]:
            raise rejection(f"got {list(ends)}, which is reversed; try {[ends[1], ends[0]]}")
        return ends


def _drawn(kind: Any) -> Drawn:
    """Return what reads a quantity that is fixed or drawn, given the type of one that is fixed."""
    return Drawn(next(each for each in kind.__metadata__ if isinstance(each, Quantity)))


_Density = Annotated[
    float, Quantity("a density per square metre", 1e-12, 1e6, "the mean number over the area")
]
_NEEDED = {
    "disc": ("centre_m", "radius_m", "count"),
    "rectangle": ("x_m", "y_m", "count"),
    "poisson": ("density_per_m2",),
    "clusters": ("parents", "count", "spread_m"),
}
_Layout = Annotated[str, Choice("a layout", tuple(_NEEDED))]
_IN_A_REGION = ("poisson", "clusters")
_REGIONS = (("centre_m", "radius_m"), ("x_m", "y_m"))
_PLACING = ("count", "density_per_m2", "parents", "spread_m", *_REGIONS[0], *_REGIONS[1])


class Points(Section):
    """Where the points of one kind are drawn, how many, how high and how strong.

    Args:
        layout: disc, rectangle, poisson or clusters.
        count: how many, a number or a range; of clusters, in each of them.
        centre_m, radius_m: the disc that they lie in; or else
        x_m, y_m: the rectangle.
        density_per_m2: of a Poisson process: the mean number over the area.
        parents: how many clusters, a number or a range.
        spread_m: of clusters: standard deviation of each coordinate from its cluster's centre.
        height_m: altitude.
        name: the name of one alone; the beginning of the names of several.
    """

    letter: ClassVar[str] = ""

    layout: _Layout = Field(
        description="How they are placed: disc or rectangle (evenly in it), poisson (a Poisson process in "
        "either) or clusters (around centres that lie evenly in either).",
        examples=["disc"],
    )
    count: Annotated[tuple[int, int], _Number("a number of points", 0)] | None = Field(
        default=None,
        description="How many: a number, or a range [fewest, most] that one is drawn from evenly. Of "
        "clusters: in each. Not with poisson.",
        examples=[10],
    )
    centre_m: PlanePoint | None = Field(
        default=None, description="Centre of the disc [east, north].", examples=[[0.0, 25.0]]
    )
    radius_m: RadiusMetres | None = Field(
        default=None, description="Radius of the disc, in metres.", examples=[60.0]
    )
    x_m: Range | None = Field(
        default=None, description="Western and eastern end of the rectangle.", examples=[[-50.0, 50.0]]
    )
    y_m: Range | None = Field(
        default=None, description="Southern and northern end of the rectangle.", examples=[[0.0, 80.0]]
    )
    density_per_m2: _Density | None = Field(
        default=None, description="Of poisson: the mean number over the area.", examples=[1e-3]
    )
    parents: Annotated[tuple[int, int], _Number("a number of clusters", 1)] | None = Field(
        default=None, description="Of clusters: how many, a number or a range.", examples=[[2, 4]]
    )
    spread_m: RadiusMetres | None = Field(
        default=None,
        description="Of clusters: standard deviation of east and of north from the cluster's centre.",
        examples=[5.0],
    )
    height_m: Annotated[Distribution, _drawn(Metres)] = Field(
        default=Distribution(fixed=0.0),
        description="Altitude in metres: a number or a distribution.",
        examples=[4.0],
    )
    name: Label | None = Field(
        default=None,
        description="Name of one alone; several are numbered after it. Left out: S1, M1 or E1 and so on.",
        examples=["M"],
    )

    def faults(self, stated: Mapping[str, object]) -> Iterable[tuple[Place, str]]:
        """Returns the faults between the layout and the keys that place its points."""
        if self.layout is None:
            return
        may = {*_NEEDED[self.layout]}
        given = [key for key in _PLACING if getattr(self, key) is not None]
        for key in _NEEDED[self.layout]:
            if key not in given:
                meant = (type(self).model_fields[key].description or "").rstrip(".")
                yield (key,), f'missing; layout "{self.layout}" needs it: {meant}'
        if self.layout in _IN_A_REGION:
            may |= {*_REGIONS[0], *_REGIONS[1]}
            yield from (((), message) for message in Ways(_REGIONS).faults(given))
        for key in given:
            if key not in may:
                yield (key,), f'has no meaning with layout "{self.layout}"; remove it'

    @property
    def may_be_several(self) -> bool:
        """Whether there may be more than one point."""
        return self.layout in _IN_A_REGION or (self.count or (0, 0))[1] > 1

    def names(self, count: int) -> list[str]:
        """Return the points' names.

        Args:
            count: how many points there are.
        """
        if self.name is not None and not self.may_be_several:
            return [self.name] * count
        return [f"{self.name or self.letter}{number}" for number in range(1, count + 1)]


class Nodes(Points):
    """Where the nodes are drawn, and how strong they are.

    Args:
        power_w: transmit power [W]; or else
        power_dbm: the same in dBm; neither where the drone transmits.
        weight: what each node's SINR is divided by; or else
        min_sinr_db: what it requires [dB].
    """

    letter: ClassVar[str] = "S"
    ways: ClassVar[tuple[Ways, ...]] = (
        at_most_one("power_w", "power_dbm"),
        at_most_one("weight", "min_sinr_db"),
    )

    power_w: Annotated[Distribution, _drawn(Watts)] | None = Field(
        default=None, description="Transmit power in watts: a number or a distribution.", examples=[1.0]
    )
    power_dbm: Annotated[Distribution, _drawn(DecibelMilliwatts)] | None = Field(
        default=None, description="The same in dBm. Either this or power_w.", examples=[{"normal": [20, 6]}]
    )
    weight: Annotated[Distribution, _drawn(Weight)] | None = Field(
        default=None,
        description="What a node's SINR is divided by: a number or a distribution.",
        examples=[2],
    )
    min_sinr_db: Annotated[Distribution, _drawn(RatioDecibels)] | None = Field(
        default=None, description="The SINR that a node requires, in dB. Either this or weight.", examples=[3]
    )


class Jammers(Points):
    """Where the jammers are drawn, and how strong they are.

    Args:
        power_w: transmit power [W]; or else
        power_dbm: the same in dBm.
        uncertainty_m: radius of the ball that each is known to be in [m].
    """

    letter: ClassVar[str] = "M"
    ways: ClassVar[tuple[Ways, ...]] = (exactly_one("power_w", "power_dbm"),)

    power_w: Annotated[Distribution, _drawn(Watts)] | None = Field(
        default=None,
        description="Transmit power in watts: a number or a distribution.",
        examples=[{"log_uniform": [0.1, 100.0]}],
    )
    power_dbm: Annotated[Distribution, _drawn(DecibelMilliwatts)] | None = Field(
        default=None, description="The same in dBm. Either this or power_w.", examples=[{"normal": [30, 6]}]
    )
    uncertainty_m: Annotated[Distribution, _drawn(ErrorMetres)] | None = Field(
        default=None,
        description="Radius of the ball that a jammer is known to be in: a number or a distribution.",
        examples=[2.0],
    )


class Eavesdroppers(Points):
    """Where the eavesdroppers are drawn.

    Args:
        uncertainty_m: radius of the ball that each is known to be in [m].
    """

    letter: ClassVar[str] = "E"

    uncertainty_m: Annotated[Distribution, _drawn(ErrorMetres)] | None = Field(
        default=None,
        description="Radius of the ball that one is known to be in: a number or a distribution.",
        examples=[2.0],
    )
