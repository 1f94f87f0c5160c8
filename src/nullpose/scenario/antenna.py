"""Which antenna the drone carries: one, or an array of dipoles."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from nullpose.antenna import ANTENNAS, AnyAntenna
from nullpose.antenna.harmonics import HIGHEST_DEGREE
from nullpose.errors import ScenarioError
from nullpose.files import PlainTable
from nullpose.scenario.faults import ONLY_LOCAL, Place, key_faults
from nullpose.scenario.rules import Choice, Count, Limits, ListOf
from nullpose.scenario.section import Section, optional
from nullpose.scenario.units import DecibelsIsotropic, Hertz, NullDepthDecibels

_MOST_ROWS = HIGHEST_DEGREE + 1

_Row = Annotated[
    tuple[Annotated[float, Limits("a coefficient", -1e9, 1e9, "gains are linear here")], ...],
    ListOf("a list of 2 n + 1 numbers for degree n", 1, 2 * _MOST_ROWS - 1),
]


class Antenna(Section, unstated=("kind", "normalise", "gain_dbi")):
    """The drone's antenna.

    Args:
        kind: dipole, half-wave, profile or pattern.
        null_depth_db: how far a dipole's gain along the axis is below that across it [dB]; None for a perfect
            null.
        file: name of the file that a profile or a pattern is from, relative to the scenario's.
        format: the file's format; None where the file tells it.
        frequency_hz: which of a file's frequencies [Hz]; as read, where the file says it.
        two_cuts: "sum-of-losses" for an estimate from two cuts.
        normalise: "peak" for a largest gain of 1, "none" for the file's gain.
        gain_dbi: its gain across its axis, or where it is largest, over an isotropic antenna [dBi].
        harmonics: what was read of the file: the terms of its spherical harmonics, by degree.
    """

    kind: Annotated[str, Choice("an antenna", ANTENNAS)] = Field(
        default="dipole",
        description="Which antenna: "
        + "; ".join(f'"{name}", {kind.summary}' for name, kind in ANTENNAS.items())
        + ".",
        examples=list(ANTENNAS),
    )
    null_depth_db: NullDepthDecibels | None = optional(
        "How deep the dipole's null is, in dB below its broadside gain: on an airframe 15 to 35. "
        "Left out: the null is perfect.",
        30.0,
    )
    file: str | None = optional(
        "Name of a file in the scenario's folder or below it: for a profile a CSV file of "
        "angle_deg and gain_dbi, for a pattern a file of a format below.",
        "hexarotor.out",
    )
    format: str | None = optional(
        'The format of a pattern\'s file: "nec", "ffd", "ffs", "cst", "msi", "mininec" or "csv". '
        "Left out: the file tells it.",
        "nec",
    )
    frequency_hz: Hertz | None = optional("Which of several frequencies in the file, in Hz.", 2.4e9)
    two_cuts: Annotated[str, Choice("a way to read two cuts", ("sum-of-losses",))] | None = optional(
        '"sum-of-losses": make an estimate of two cuts (msi) of an antenna that is not the same '
        "all round, and say so in every result. Left out: such cuts are refused, as they do not tell the "
        "pattern.",
        "sum-of-losses",
    )
    normalise: Annotated[str, Choice("a way to normalise", ("none", "peak"))] = Field(
        default="none",
        description='"none": gains are over an isotropic antenna, as in the file; "peak": the largest gain '
        "is 1, like that of the paper's dipole.",
        examples=["none", "peak"],
    )
    gain_dbi: DecibelsIsotropic = Field(
        default=0.0,
        description="Gain of the antenna in the direction where it is largest, in dBi: 1.76 for a short "
        'dipole, 2.15 for a half-wave dipole. With a file only where normalise = "peak", since its gains '
        "are in dBi. Left out: 0, as in the paper.",
        examples=[1.76],
    )
    harmonics: (
        Annotated[tuple[_Row, ...], ListOf("a list of lists, one for each degree from 0", 1, _MOST_ROWS)]
        | None
    ) = optional(
        "What was read of the file, written by nullpose: for each degree of the gain's spherical "
        "harmonics its cosine terms, then its sine terms. With them the file is not needed."
    )

    def faults(self, raw: PlainTable) -> Iterable[tuple[Place, str]]:
        """Return keys that have no meaning for the kind, and what a profile or a pattern lacks."""
        if self.kind is None:
            return
        kind = ANTENNAS[self.kind]
        strange = raw.keys() - {"kind", "gain_dbi", *kind.keys}
        yield from key_faults(
            raw, strange, f'has no meaning with kind = "{self.kind}"; remove it, or state another kind'
        )
        if self.gain_dbi and kind.read is not None and self.normalise == "none":
            yield (
                ("gain_dbi",),
                f"got {self.gain_dbi:g}, but the gains in the file are over an isotropic antenna, and this "
                'would add to them; remove it, or write normalise = "peak", and the largest gain is this one',
            )
        if kind.read is not None and "harmonics" not in raw:
            missing = f'missing, but kind = "{self.kind}" needs it; add the name of a file'
            yield ("file",), f"{ONLY_LOCAL}; load that file by its path" if "file" in raw else missing
        yield from (
            (("harmonics", n), f"got {len(row)} numbers, must be {2 * n + 1}: 2 n + 1 for degree n")
            for n, row in enumerate(self.harmonics or ())
            if len(row) != 2 * n + 1
        )

    @cached_property
    def record(self) -> AnyAntenna:
        """What the antenna states of itself."""
        kind = ANTENNAS[self.kind]
        return kind.make(**{key: getattr(self, key) for key in kind.keys})


def with_harmonics(table: PlainTable, path: Path) -> tuple[PlainTable, tuple[str, ...]]:
    """Fill in a raw table what its file holds, with notes; leave it where another of its keys is at fault.

    Args:
        table: of a kind that has a file, or of any other.
        path: of its file.

    Raises:
        ScenarioError: the file cannot be read as stated.
    """
    name = table.get("kind")
    kind = ANTENNAS.get(name) if isinstance(name, str) else None
    if kind is None or kind.read is None:
        return dict(table), ()
    unread = {**table, "harmonics": [[1.0]]}
    try:
        Antenna.from_dict(unread)
    except ScenarioError:
        return unread, ()  # its faults are told with the rest of the scenario's
    found, notes = kind.read(path, table)
    return {**table, **found}, notes


_DIGITAL = "digital combining, which nullpose solves with a bound (analogue combining has none)"


class Array(Section, header="a table with elements, layout and spacing_wavelengths", unstated=("combining",)):
    """Upright dipoles on a horizontal vehicle, in a row or on a circle, with yaw free.

    Args:
        elements: number of dipoles.
        layout: linear, evenly spaced on a horizontal line; or circular, evenly spaced on such a circle.
        spacing_wavelengths: distance between neighbours in wavelengths.
        combining: digital.
    """

    elements: Annotated[int, Count("a number of elements", 1, 64, "count the dipoles")] = Field(
        description="Number of upright dipoles.", examples=[4]
    )
    layout: Annotated[Literal["linear", "circular"], Choice("a layout", ("linear", "circular"))] = Field(
        description="How they stand: linear (on a horizontal line) or circular (on a horizontal circle).",
        examples=["linear"],
    )
    spacing_wavelengths: Annotated[
        float, Limits("a length in wavelengths", 1e-3, 1e3, "half a wavelength is 0.5")
    ] = Field(description="Distance between neighbours, in wavelengths.", examples=[0.5])
    combining: Annotated[Literal["digital"], Choice(_DIGITAL, ("digital",))] = Field(
        default="digital",
        description="How the elements are combined: digital, which need not be stated.",
        examples=["digital"],
    )
