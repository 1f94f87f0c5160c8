"""Line of sight by elevation: its probability grows with the drone's elevation angle at the ground point.

``P = 1 / (1 + a exp(-b (theta - a)))``, theta in degrees. Source: Al-Hourani, Kandeepan and Lardner, "Optimal
LAP altitude for maximum coverage", IEEE Wireless Communications Letters 2014. Losses are over free space, or
over a power law of any other exponent.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from nullpose.channel.convex import FloatArray
from nullpose.channel.model import (
    AVERAGE,
    BY_ELEVATION,
    HIDDEN,
    ONSET,
    RATE,
    ChannelModel,
    LinkChannel,
    channel_row,
)
from nullpose.channel.power_law import distance_excess, power_law
from nullpose.channel.profile import knots_of, log_gain


class Environment(NamedTuple):
    """The numbers of an environment: of the probability, and the losses with line of sight and without."""

    a: float
    b: float
    los_loss_db: float
    nlos_loss_db: float


ENVIRONMENTS = {
    "suburban": Environment(4.88, 0.43, 0.1, 21.0),
    "urban": Environment(9.61, 0.16, 1.0, 20.0),
    "dense-urban": Environment(12.08, 0.11, 1.6, 23.0),
    "high-rise": Environment(27.23, 0.08, 2.3, 34.0),
}
"""At 2 GHz, of the source."""

POWER_AVERAGE, DB_AVERAGE = 0.0, 1.0
AVERAGES = ("power", "db", "guaranteed")


def sight_probability(row: FloatArray, elevation_rad: FloatArray) -> FloatArray:
    """Evaluate the probability P of line of sight.

    Args:
        row: with ``ln a + a b``, and b per radian.
        elevation_rad: of the drone, at the ground point.
    """
    exponent = row[ONSET] - row[RATE] * elevation_rad
    small = np.exp(-np.abs(exponent))  # neither this nor its quotient overflows
    return np.asarray(np.where(exponent > 0.0, small, 1.0) / (1.0 + small))


def elevation_excess(
    row: FloatArray, distance_m: FloatArray, elevation_rad: FloatArray, azimuth_rad: FloatArray
) -> FloatArray:
    """Evaluate the mean gain over that with line of sight: ``n + (1 - n) P``, or ``n^(1 - P)``.

    So written nothing cancels, however small n and P are. The power law and the profile of the ground antenna
    multiply it.

    Args:
        row: of the channel; n is the gain without line of sight over that with it.
        distance_m: d, for the power law.
        elevation_rad: of the drone, at the ground point.
        azimuth_rad: of no effect.
    """
    p, n = sight_probability(row, elevation_rad), row[HIDDEN]
    gain = np.where(row[AVERAGE] == DB_AVERAGE, n ** (1.0 - p), n + (1.0 - n) * p)
    law = distance_excess(row, distance_m, elevation_rad, azimuth_rad)
    return np.asarray(law * gain * np.exp(log_gain(row, elevation_rad)))


def elevation_channel(
    a: float,
    b: float,
    los_loss_db: float,
    nlos_loss_db: float,
    average: str,
    exponent: float = 2.0,
    reference_distance_m: float = 1.0,
    is_interferer: bool = False,
) -> LinkChannel:
    """Return the mean channel of a link that has line of sight with the probability P.

    Args:
        a: of the probability, in degrees.
        b: of the probability, per degree.
        los_loss_db: loss over the power law with line of sight.
        nlos_loss_db: the same without.
        average: "power", the mean of the gains; "db", the mean of the losses in dB, as published; or
            "guaranteed", where interferers always have line of sight and all others never.
        exponent: of the power law; 2 is free space.
        reference_distance_m: of the power law.
        is_interferer: whether the link is that of a jammer or an eavesdropper.

    Example:
        >>> urban = elevation_channel(*ENVIRONMENTS["urban"], average="power")
        >>> gain = urban.strength * urban.excess(urban.row, 316.2, math.atan2(100.0, 300.0), 0.0)
        >>> round(-10.0 * math.log10(gain), 4)
        6.1133
    """
    seen, hidden = (10.0 ** (-loss_db / 10.0) for loss_db in (los_loss_db, nlos_loss_db))
    law = power_law(exponent, reference_distance_m)
    if average == "guaranteed":
        return law._replace(strength=law.strength * (seen if is_interferer else hidden))
    kept = DB_AVERAGE if average == "db" else POWER_AVERAGE
    sight = math.log(a) + a * b, math.degrees(b), hidden / seen, kept
    return LinkChannel(
        law.strength * seen, channel_row(BY_ELEVATION, law.row[1:ONSET], sight), elevation_excess
    )


def with_profile(channel: LinkChannel, elevation_deg: ArrayLike, gain_dbi: ArrayLike) -> LinkChannel:
    """Return a channel times the profile of the antenna on the ground.

    Its largest gain, of which the excess is what is left elsewhere, is the antenna's own.

    Args:
        channel: without a profile.
        elevation_deg: (n,) of the antenna's table, rising from -90 to 90.
        gain_dbi: (n,) the gains there.
    """
    knots = knots_of(elevation_deg, gain_dbi)
    row = (BY_ELEVATION, *channel.row[1:], float(len(knots)), *knots.ravel().tolist())
    return LinkChannel(channel.strength, row, elevation_excess)


ELEVATION = ChannelModel(
    "line of sight with a probability that grows with the elevation angle",
    elevation_channel,
    dict.fromkeys(("a", "b", "los_loss_db", "nlos_loss_db"))
    | {"average": "power", "exponent": 2.0, "reference_distance_m": 1.0},
)
