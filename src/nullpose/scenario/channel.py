"""Which channel a link has: free space, a power law, or line of sight by elevation."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated

from pydantic import BeforeValidator, Field, SkipValidation

from nullpose.channel import CHANNELS, ENVIRONMENTS, Custom, LinkChannel
from nullpose.channel.elevation import AVERAGES
from nullpose.files import PlainTable
from nullpose.scenario.faults import Place
from nullpose.scenario.rules import ByName, Choice, Limits
from nullpose.scenario.section import Section, optional
from nullpose.scenario.units import LossDecibels, ratio_from_db
from nullpose.scenario.ways import Ways

EnvironmentName = Annotated[str, Choice("an environment", tuple(ENVIRONMENTS))]
"""The type of a key that names a built-up area."""
_NUMBERS = ("a", "b", "los_loss_db", "nlos_loss_db")


BLOCKED_DB = 20.0
"""Loss of a link that a building blocks, where none is stated [dB]."""
SHADOW_MARGIN_M = 0.5
"""How far around the drone the line of sight counts, where it is not stated [m]."""


class Channel(Section, ways=(Ways((("environment",), _NUMBERS), fewest=0),)):
    """How the power of a link falls with distance and elevation.

    Args:
        model: a key of ``CHANNELS``: free-space, power-law or elevation.
        exponent: of the path loss, by a power law or by elevation.
        reference_distance_m: where it has the receiver's reference gain [m]; 1 if left out.
        environment: a key of ``ENVIRONMENTS``; or else
        a, b, los_loss_db, nlos_loss_db: its numbers [deg, 1/deg, dB, dB].
        average: power, db or guaranteed.
        blocked_loss_db: loss of a link that a building blocks [dB].
        shadow_margin_m: distance from the drone within which the worst line of sight counts [m].
    """

    model: Annotated[str, Choice("a channel model", CHANNELS)] = Field(
        default="free-space",
        description="Which channel: "
        + "; ".join(f'"{name}", {model.summary}' for name, model in CHANNELS.items())
        + ".",
        examples=list(CHANNELS),
    )
    exponent: (
        Annotated[
            float,
            Limits(
                "a path-loss exponent", 1.6, 6.0, "2 is that of free space; the loss is 10 x it dB/decade"
            ),
        ]
        | None
    ) = optional(
        "Exponent of the path loss, of a power law and by elevation: the gain is the reference gain times "
        "(distance / reference distance)^-exponent, and by elevation less the losses. There, left out: 2.",
        2.4,
    )
    reference_distance_m: (
        Annotated[float, Limits("a distance in m", 1e-3, 1e7, "where the reference gain holds; mostly 1")]
        | None
    ) = optional(
        "The distance in metres at which that power law has the reference gain of [receiver]; at most the "
        "keep-out radius. Left out: 1.",
        1.0,
    )
    environment: EnvironmentName | None = optional(
        "Where the ground points are, for elevation: the source's numbers at 2 GHz. Either this, or a, b, "
        "los_loss_db and nlos_loss_db.",
        "urban",
    )
    a: (
        Annotated[float, Limits("an angle in degrees", 0.1, 90.0, "4.88 is suburban, 27.23 high-rise")] | None
    ) = optional(
        "Of the probability of line of sight 1 / (1 + a exp(-b (theta - a))), theta the elevation angle: a, "
        "in degrees.",
        9.61,
    )
    b: (
        Annotated[float, Limits("a number per degree", 1e-3, 5.0, "0.43 is suburban, 0.08 high-rise")] | None
    ) = optional("The same: b, per degree.", 0.16)
    los_loss_db: LossDecibels | None = optional(
        "Loss with line of sight over free space, or over the power law, in dB.", 1.0
    )
    nlos_loss_db: LossDecibels | None = optional("The same without line of sight, in dB.", 20.0)
    average: Annotated[str, Choice("an average", AVERAGES)] | None = optional(
        'What counts of links with and without line of sight, for elevation: "power", the mean power; "db", '
        'the mean of the losses in dB, as published; or "guaranteed": nodes never have line of sight, and '
        "jammers and eavesdroppers always have. Without meaning among buildings, which decide.",
        "power",
    )
    blocked_loss_db: (
        Annotated[float, Limits("a loss in dB", 1e-3, 200.0, "20 dB leave a hundredth")] | None
    ) = optional(
        f"Loss in dB where a building blocks the line of sight. Left out: {BLOCKED_DB:g}. By elevation the "
        "losses with and without line of sight count.",
        BLOCKED_DB,
    )
    shadow_margin_m: (
        Annotated[float, Limits("a length in m", 0.0, 1000.0, "0 counts the line of sight of the pose alone")]
        | None
    ) = optional(
        "Distance in metres: a link to a node counts as clear of buildings only if it is so for the drone "
        "anywhere within it, and one to a jammer or an eavesdropper as blocked likewise. Only in the "
        f"scenario's [channel]. Left out: {SHADOW_MARGIN_M:g}.",
        SHADOW_MARGIN_M,
    )

    def faults(self, raw: PlainTable) -> Iterable[tuple[Place, str]]:
        """Return keys that have no meaning for the model, what it lacks, and losses that are exchanged."""
        if self.model is None:
            return
        present, named = {key for key in raw if raw[key] is not None}, f'model = "{self.model}"'
        for key in sorted(present - {"model", "blocked_loss_db", "shadow_margin_m", *_keys_of(self.model)}):
            others = " or ".join(f'model = "{name}"' for name in CHANNELS if key in _keys_of(name))
            yield (key,), f"has no meaning with {named}; remove it, or write {others}"
        yield from (
            ((key,), f"missing, but {named} needs it; add it: {type(self).model_fields[key].description}")
            for key, default in CHANNELS[self.model].keys.items()
            if default is None and key not in present | {*_NUMBERS}
        )
        if "environment" in _keys_of(self.model) and present.isdisjoint(("environment", *_NUMBERS)):
            instead = f"{', '.join(_NUMBERS[:-1])} and {_NUMBERS[-1]}"
            yield ("environment",), f"missing, but {named} needs it, or {instead}; add either"
        seen, hidden = self.los_loss_db, self.nlos_loss_db
        if seen is not None and hidden is not None and hidden < seen:
            yield (
                ("nlos_loss_db",),
                f"got {hidden:g}, less than los_loss_db = {seen:g}: losses that make "
                "line of sight the weaker; exchange them",
            )

    @property
    def is_by_sight(self) -> bool:
        """Whether its loss depends on line of sight, which elevation or buildings decide."""
        return not hasattr(self, "law") and "average" in CHANNELS[self.model].keys

    @property
    def gain_distance_m(self) -> float:
        """The distance at which the reference gain holds [m]."""
        return self.reference_distance_m or 1.0

    def describe(self, *, among_buildings: bool) -> str:
        """Put into words what it is, as in ``elevation, environment urban, average power``.

        Args:
            among_buildings: whether these decide on line of sight: then there is neither probability nor
                average.
        """
        sure = among_buildings and self.is_by_sight
        used = [key for key in _keys_of(self.model) if not (sure and key in ("a", "b", "average"))]
        keys = [key for key in used if getattr(self, key) is not None]
        numbers = [f"{key.replace('_', ' ')} {getattr(self, key)}" for key in keys]
        return ", ".join([self.model, *numbers, *["line of sight by buildings"] * sure])

    def make(self, is_interferer: bool) -> LinkChannel:
        """Return the channel of a link.

        Args:
            is_interferer: whether it is that of a jammer or an eavesdropper.
        """
        named = {} if self.environment is None else ENVIRONMENTS[self.environment]._asdict()
        model = CHANNELS[self.model]
        values = {**model.keys, **named} | {key: value for key, value in self if value is not None}
        return model.make(**{key: values[key] for key in model.keys}, is_interferer=is_interferer)

    def in_sight(self, is_interferer: bool, blocked_loss_db: float) -> LinkChannel:
        """Return the channel of a link among buildings, which decide on its line of sight.

        By elevation it has the loss with line of sight, or where a building blocks it the one without; the
        probability and the average are not used.

        Args:
            is_interferer: whether it is that of a jammer or an eavesdropper.
            blocked_loss_db: of any other model, where a building blocks it.
        """
        if not self.is_by_sight:
            return self.make(is_interferer).behind_buildings(ratio_from_db(-blocked_loss_db))
        sure = self.model_copy(update={"average": "guaranteed"})
        seen, hidden = sure.make(True), sure.make(False)
        return seen.behind_buildings(hidden.strength / seen.strength)


def _keys_of(model: str) -> tuple[str, ...]:
    """List the keys that have a meaning for a model: its own, and one that stands for some of them."""
    keys = (*CHANNELS[model].keys,)
    return ("environment", *keys) if "a" in keys else keys


class CustomChannel(Channel):
    """A channel from Python, which no file can hold.

    Args:
        law: what the user stated.
    """

    law: SkipValidation[Custom] = Field(exclude=True)

    def faults(self, raw: PlainTable) -> Iterable[tuple[Place, str]]:
        """Return no faults: the law has judged itself."""
        return ()

    def describe(self, *, among_buildings: bool) -> str:
        """Return its name."""
        return self.law.name

    def make(self, is_interferer: bool) -> LinkChannel:
        """Return the channel of a link, an interferer's or not."""
        return self.law.link()


_OR_NAME = ByName(
    'a table such as { model = "power-law", exponent = 2.4 }, or the name of a model that needs no numbers',
    {name: {"model": name} for name, model in CHANNELS.items() if not model.keys},
)
_OF_LAW = BeforeValidator(
    lambda value: (
        CustomChannel.model_construct(model=value.name, law=value) if isinstance(value, Custom) else value
    )
)
NamedChannel = Annotated[Channel, _OF_LAW, _OR_NAME]
"""The type of a point's key ``channel``: a table, or the name of a model."""
