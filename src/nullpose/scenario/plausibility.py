"""What looks like a mistake: places in degrees, powers in another unit, altitudes over something else."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from nullpose.errors import Fault
from nullpose.scenario.faults import Place
from nullpose.scenario.origin import POINT_LISTS, Origin
from nullpose.scenario.radio import Noisy, Powered
from nullpose.scenario.units import EARTHLY_CORNERS, HALF_DB, MOST_OVER_FED_DB, watts_from_dbm

if TYPE_CHECKING:
    from nullpose.scenario.ground_points import GroundPoint
    from nullpose.scenario.scenario import Scenario
    from nullpose.scenario.section import Section

# Smaller outlines are taken for a mistake: a share of the points' spread, but at most so many metres.
_LEAST = {"geofence_m": (1e-2, 5.0), "polygon_m": (1e-3, 0.1)}
_LEAST_OF_KEEP_OUT = 1e-2  # likewise a geofence, as a share of keep_out_m
_NEAR_DEG = 0.1  # metres that are so close to the origin's latitude and longitude are likely degrees
_DBM = (10.0, 60.0)  # powers in W that are likely to be dBm
_OFF_M = 15.0  # points that all lie so far off the origin's altitude are unlikely
_FAINTEST_DBM = -145.0  # noise below it is unlikely: that of 1 kHz at 290 K is -144 dBm
_SAME_BAND = 0.2  # of the frequency: how far a pattern's may be from the carrier's
_LEAST_MEAN_DB = -6.0  # below it, a pattern is likely relative to its peak
_LOWEST_HZ = 1e6  # carriers below it are unlikely


def too_small(
    tables: Mapping[Place, Section], positions_m: Sequence[tuple[float, float, float]]
) -> Iterator[tuple[Place, str]]:
    """Yield the outlines that are far too small for the ground points, as if they were in another unit.

    The longer side of a fence is to be a hundredth of the points' spread or more (5 m always do), and a
    hundredth of the keep-out radius; that of a zone's polygon a thousandth of the spread (0.1 m always do).

    Args:
        tables: the airspace and its zones by their place, and any others.
        positions_m: of the ground points [m].
    """
    span_m = max((np.ptp(axis) for axis in list(zip(*positions_m, strict=True))[:2]), default=0.0)
    for (place, table), (key, (share, most_m)) in product(tables.items(), _LEAST.items()):
        keep_out_m = getattr(table, "keep_out_m", None) or 0.0
        least_m, why = max(
            (min(share * span_m, most_m), f"the ground points are {span_m:.3g} m apart"),
            (_LEAST_OF_KEEP_OUT * keep_out_m, f"keep_out_m is {keep_out_m:g} m"),
        )
        if (corners_m := getattr(table, key, None)) and np.ptp(corners_m, axis=0).max() < least_m:
            east_m, north_m = np.ptp(corners_m, axis=0)
            earthly = next(each for each, metric in EARTHLY_CORNERS.items() if metric == key)
            yield (
                (*place, key if getattr(table, earthly) is None else earthly),
                f"it is {east_m:.2g} m by {north_m:.2g} m, but {why}, so it must be {least_m:.2g} m or more "
                f"across: this looks like degrees or another unit; write {earthly} = [[latitude, longitude], "
                "...] and an [origin], or the corners in metres east and north of the origin",
            )


def close_to_degrees(origin: Origin | None, positions_m: Sequence[ArrayLike], remedy: str) -> Iterator[str]:
    """Yields, of the first position whose metres are close to the origin's latitude and longitude, its words.

    Args:
        origin: of the scenario, or None.
        positions_m: east, north and up [m].
        remedy: what to write for degrees.
    """
    if origin is None or not len(positions_m) or max(abs(origin.lat_deg), abs(origin.lon_deg)) < 1.0:
        return  # near latitude and longitude zero small numbers are as likely metres
    origin_deg, planes_m = np.array([origin.lat_deg, origin.lon_deg]), np.array(positions_m)[:, :2]
    apart = np.minimum(*(np.abs(planes_m - each).max(axis=1) for each in (origin_deg, origin_deg[::-1])))
    if apart.min() < _NEAR_DEG:
        east_m, north_m = planes_m[apart.argmin()]
        yield (
            f"{east_m:g} m east and {north_m:g} m north are close to the origin's latitude and longitude "
            f"({origin.lat_deg:g}, {origin.lon_deg:g}), as if they were degrees; if they are, give {remedy}"
        )


def doubts(scenario: Scenario) -> tuple[Fault, ...]:
    """Find what looks like a mistake in a sound scenario, each with its place.

    Powers in W that would be likely in dBm, where the file states other transmit powers in dBm; noise less
    than that of 1 kHz; a carrier below 1 MHz; nodes' gains that an antenna has in some directions only;
    points in metres that are close to the origin's latitude and longitude; points that all lie as far off the
    origin's altitude as the sea, the ellipsoid and the ground may be apart.

    Args:
        scenario: any.

    Example:
        >>> import nullpose
        >>> doubts(nullpose.load("examples/paper.toml"))
        ()
    """
    points = {
        f"{kind}[{index}]": point
        for kind in POINT_LISTS
        for index, point in enumerate(getattr(scenario, kind))
    } | ({} if scenario.destination is None else {"destination": scenario.destination})
    metric_m = [point.position_m for point in points.values() if point.lat_deg is None]
    return (
        *_powers(scenario, points),
        *_noises(scenario, points),
        *_gains(points),
        *_patterns(scenario),
        *(
            Fault("position_m", message)
            for message in close_to_degrees(scenario.origin, metric_m, "lat_deg, lon_deg and an altitude")
        ),
        *_altitudes(points),
    )


def _powers(scenario: Scenario, points: Mapping[str, GroundPoint]) -> Iterator[Fault]:
    powers = {
        place: each
        for place, each in {**points, "transmitter": scenario.transmitter}.items()
        if isinstance(each, Powered)
    }
    in_dbm = [emitter.power_dbm for emitter in powers.values()]
    for place, emitter in powers.items() if any(dbm is not None for dbm in in_dbm) else ():
        if (power := emitter.power_w) is not None and _DBM[0] <= power <= _DBM[1]:
            yield Fault(
                f"{place}.power_w",
                f"{power:g} W is {10.0 * math.log10(power) + 30.0:.1f} dBm, and other transmit powers are "
                "stated in dBm; "
                f"if {power:g} dBm ({watts_from_dbm(power):.3g} W) is meant, write power_dbm = {power:g}",
            )


def _noises(scenario: Scenario, points: Mapping[str, GroundPoint]) -> Iterator[Fault]:
    receivers = {"receiver": scenario.receiver, **points}
    noises_w = {place: each.noise_power_w for place, each in receivers.items() if isinstance(each, Noisy)}
    yield from (
        Fault(
            place,
            f"its noise is {10.0 * math.log10(noise_w) + 30.0:.1f} dBm, less than the thermal noise of 1 kHz "
            "(-144 dBm), as if it were a density in dBm/Hz, or a bandwidth in kHz or MHz; if it is, add "
            "10 log10(bandwidth in Hz) to noise_dbm, or state bandwidth_hz and noise_figure_db",
        )
        for place, noise_w in noises_w.items()
        if 0.0 < noise_w < watts_from_dbm(_FAINTEST_DBM)
    )
    if (hz := scenario.receiver.frequency_hz or math.inf) < _LOWEST_HZ:
        yield Fault(
            "receiver.frequency_hz",
            f"{hz:g} Hz is below 1 MHz, as if it were in kHz or MHz; {hz:g} MHz is written {1e6 * hz:g}",
        )


def _gains(points: Mapping[str, GroundPoint]) -> Iterator[Fault]:
    """Yield the gains that some antennas have in some directions only.

    They count in every direction, which is the worst case of who is unwanted.
    """
    whips = {place: point for place, point in points.items() if point.antenna == "dipole"}
    others = {place: point for place, point in points.items() if not (point.is_interferer or place in whips)}
    ground, turned = "above a large ground plane", "of an antenna that is turned to the drone"
    yield from (
        Fault(
            f"{place}.gain_dbi",
            f'{point.gain_dbi:g} dBi with antenna = "{point.antenna}" is true only {only}: all round '
            f"it is {point.over_fed_db:.1f} dB more than the antenna is fed; a collinear whip is antenna = "
            '"profile", its gain by elevation',
        )
        for only, most_db, antennas in ((ground, 0.0, whips), (turned, HALF_DB, others))
        for place, point in antennas.items()
        if point.over_fed_db > MOST_OVER_FED_DB + most_db
    )


def _patterns(scenario: Scenario) -> Iterator[Fault]:
    """Yield that a file's pattern is of another frequency, or likely relative to its peak."""
    antenna, carrier_hz = scenario.antenna, scenario.receiver.frequency_hz
    if antenna is None or antenna.file is None:
        return
    pattern_hz = antenna.frequency_hz or carrier_hz or 0.0
    if abs(pattern_hz - (carrier_hz or pattern_hz)) > _SAME_BAND * pattern_hz:
        words = f"the pattern is at {pattern_hz:g} Hz, and receiver.frequency_hz = {carrier_hz:g}"
        yield Fault("antenna.frequency_hz", f"{words}; give the pattern at the carrier's frequency")
    mean_db = 10.0 * math.log10(max(antenna.record.mean, 1e-30))
    if antenna.normalise == "none" and mean_db < _LEAST_MEAN_DB:
        yield Fault(
            "antenna.file",
            f"the gain averages to {mean_db:.1f} dB over the sphere, as if it were relative to its peak; if "
            'it is, write normalise = "peak" and the gain there as gain_dbi',
        )


def _altitudes(points: Mapping[str, GroundPoint]) -> Iterator[Fault]:
    heights_m = {place: point.position_m[2] for place, point in points.items() if point.alt_m is not None}
    least_m = min(map(abs, heights_m.values()), default=0.0)
    if least_m >= _OFF_M and np.ptp([*heights_m.values()]) <= least_m:
        first, height_m = next(iter(heights_m.items()))
        yield Fault(
            first,
            f"this and all other points in alt_m lie {least_m:.0f} m or more "
            f"{'above' if height_m > 0.0 else 'below'} the origin, as if their altitudes were over something "
            "else; check that alt_m is over the ellipsoid, and write alt_msl_m for altitudes over the sea, "
            "alt_agl_m for those above the ground",
        )
