"""The subject of a certificate: as data, against a given scenario, and as the sentence that was proved."""

from __future__ import annotations

import math
from collections.abc import Iterator
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal

from nullpose.certificate.certificate import Certificate
from nullpose.certificate.claim import VALUE_RTOL
from nullpose.certificate.file import scenario_digest
from nullpose.files import PlainTable
from nullpose.objectives import Quantity
from nullpose.problem.build import build_family
from nullpose.problem.family import still_scenes
from nullpose.problem.schemes import RECORDS
from nullpose.scenario import Scenario


def subject(certificate: Certificate) -> PlainTable:
    """Collect the claim of a certificate, its scenario and the scenario's digest as plain data."""
    scenario = certificate.scenario.to_dict()
    return {
        "name": certificate.scenario.name,
        "scenario_sha256": scenario_digest(scenario),
        "scheme": certificate.scheme,
        "null_jammer": certificate.null_jammer,
        "value": certificate.value,
        "upper_bound": certificate.upper_bound,
        "instants": list(certificate.instants),
        "antenna": certificate.scenario.antenna_record.label,
        "scenario": scenario,
    }


def differences(certificate: Certificate, scenario: Scenario) -> tuple[str, ...]:
    """List where a scenario differs from a certificate's; empty if the claim is about it as well.

    Names do not count, nor does it matter in which unit a power is stated: what counts are the ratios, the
    positions and the axes that are allowed.

    Args:
        certificate: with its scenario.
        scenario: another.
    """
    if _problem(certificate.scenario) == _problem(scenario):
        return ()
    its, mine = dict(_values(certificate.scenario.to_dict())), dict(_values(scenario.to_dict()))
    return tuple(
        f"{path}: the certificate has {its.get(path, 'nothing')}, the scenario {mine.get(path, 'nothing')}"
        for path in {**its, **mine}
        if its.get(path) != mine.get(path)
    )


def _problem(scenario: Scenario) -> tuple[object, ...]:
    reach = None if (frame := scenario.airframe) is None else (frame.tilt_max_rad, frame.mount_rad)
    pattern = (
        None if scenario.antenna_record.is_quadratic else scenario.antenna
    )  # a dipole's is in the family
    digests = [
        build_family(scene, any_antenna=True, any_channel=True, any_objective=True).digest
        for scene in still_scenes(scenario)
    ]
    return digests, scenario.objective, scenario.axis_band, reach, pattern


def _values(value: object, path: str = "") -> Iterator[tuple[str, object]]:
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _values(inner, f"{path}.{key}" if path else key)
    elif isinstance(value, list | tuple) and any(isinstance(inner, dict) for inner in value):
        for index, inner in enumerate(value):
            yield from _values(inner, f"{path}[{index}]")
    else:
        yield path, value


def sentence(certificate: Certificate, leaves: int) -> str:
    """State the claim of a certificate that was proved by so many leaves."""
    most, least, near = claim_numbers(certificate)
    return (
        f"proved: {claim_words(certificate)} above {most}, and the stated pose {gives(certificate)} {least} "
        f"or more, which is within {near} of it; {leaves} final boxes checked"
    )


def gives(certificate: Certificate) -> str:
    """State what a pose does to whom, and when."""
    words = "" if (time := certificate.scenario.time) is None else f" at all {len(time.instants_s)} instants"
    return Quantity.of(certificate.scenario).gives + words


def claim_words(certificate: Certificate) -> str:
    """State what a certificate excludes, up to the number that is the bound."""
    scenario = certificate.scenario
    axes = RECORDS[certificate.scheme].sentence(scenario, certificate.null_jammer)
    quantity = Quantity.of(scenario)
    required = quantity.whole and any(node.min_sinr_db is not None for node in scenario.nodes)
    among = ", the two meeting every min_sinr_db," if required else ""
    what = f"{axes}{among} {gives(certificate)} {quantity.with_article}"
    return f"in this scenario{_left_out(certificate)} no position{_places(certificate)} {what}"


def _left_out(certificate: Certificate) -> str:
    """Name what the scenario states that a certificate does not speak of."""
    scenario = certificate.scenario
    words = [word for word, holds in (("errors", scenario.is_uncertain), ("array", scenario.array)) if holds]
    return f", its {' and '.join(words)} left out," if words else ""


def _places(certificate: Certificate) -> str:
    """Name all that bounds the positions: ranges, geofence, no-fly zones and points."""
    airspace = certificate.scenario.airspace
    zones = f"{len(airspace.no_fly)} no-fly zones" if len(airspace.no_fly) > 1 else "no-fly zone"
    areas = {"inside the geofence": airspace.geofence_m is not None, f"outside the {zones}": airspace.no_fly}
    inside = " and ".join(words for words, holds in areas.items() if holds)
    ranges = {"with x": airspace.x_m, "with y": airspace.y_m, "at an altitude": airspace.altitude_m}
    words = [f"{name} from {ends[0]!r} to {ends[1]!r} m" for name, ends in ranges.items() if ends]
    if inside:
        words.append(f"{inside} with a margin of {airspace.margin_m!r} m" if airspace.margin_m else inside)
    always = " at every instant" if certificate.instants else ""
    words.append(f"at least {airspace.keep_out_m!r} m from every point on the ground{always}")
    return f" {', '.join(words)},"


def claim_numbers(certificate: Certificate) -> tuple[str, ...]:
    """Write the bound, the value and how near they are, each rounded to the side that claims less."""
    bound, value = certificate.upper_bound, certificate.value
    least = value * (1.0 - VALUE_RTOL)
    if Quantity.of(certificate.scenario).is_rate:
        scale = Quantity.of(certificate.scenario).scale
        most_rate, least_rate = (
            max(0.0, scale * (math.log2(ratio) + slack)) for ratio, slack in ((bound, 1e-12), (least, -1e-12))
        )
        ends = _rounded(most_rate, ROUND_CEILING), _rounded(least_rate, ROUND_FLOOR)
        return tuple(f"{text} bits/s/Hz" for text in (*ends, _apart(most_rate - least_rate)))
    most_db = _rounded(10.0 * math.log10(bound) + 1e-12, ROUND_CEILING, digits=7)
    least_db = _rounded(10.0 * math.log10(value) - 1e-9, ROUND_FLOOR, digits=7)
    return (
        f"{most_db} dB ({_rounded(bound, ROUND_CEILING)})",
        f"{least_db} dB ({_rounded(least, ROUND_FLOOR)})",
        f"{_apart(bound / least - 1.0)} (relative)",
    )


def _apart(number: float) -> str:
    """Return a distance between bound and value with three digits, rounded up."""
    return f"{float(Context(prec=3, rounding=ROUND_CEILING).create_decimal(number)):.2e}"


def _rounded(number: float, direction: str, digits: int = 9) -> str:
    """Return a number with so many decimals that claims no more than it does; in full if small or large."""
    if 0.0 < number < 1e-3 or number >= 1e9:
        return repr(number)
    return format(Decimal(number).quantize(Decimal(1).scaleb(-digits), rounding=direction), "f")
