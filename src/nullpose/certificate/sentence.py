"""What was proved, in the user's terms, every number rounded so that it claims no more than it may."""

from __future__ import annotations

import math
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal

from nullpose.certificate.certificate import Certificate
from nullpose.certificate.claim import VALUE_RTOL
from nullpose.objectives import Quantity
from nullpose.problem.schemes import RECORDS


def sentence(certificate: Certificate, leaves: int) -> str:
    """Return the claim of a certificate that was proved.

    Args:
        certificate: the claim.
        leaves: how many were checked.
    """
    (most, least, near), quantity = _numbers(certificate), Quantity.of(certificate.scenario)
    axes = RECORDS[certificate.scheme].sentence(certificate.scenario, certificate.null_jammer)
    return (
        f"proved: in this scenario{_left_out(certificate)} no position{_places(certificate)} "
        f"{axes} gives every node {quantity.with_article} above {most}, and the stated pose "
        f"gives every node {least} or more, which is within {near} of it; {leaves} final boxes checked"
    )


def _left_out(certificate: Certificate) -> str:
    """Return what the scenario states that a certificate does not speak of."""
    scenario = certificate.scenario
    words = [word for word, holds in (("errors", scenario.is_uncertain), ("array", scenario.array)) if holds]
    return f", its {' and '.join(words)} left out," if words else ""


def _places(certificate: Certificate) -> str:
    airspace = certificate.scenario.airspace
    words = ["inside the geofence"] if airspace.geofence_m is not None else []
    zones = len(airspace.no_fly)
    if zones:
        words.append("outside the no-fly zone" if zones == 1 else f"outside the {zones} no-fly zones")
    margin = f" with a margin of {airspace.margin_m!r} m" if airspace.margin_m else ""
    return f" {' and '.join(words)}{margin}" if words else ""


def _numbers(certificate: Certificate) -> tuple[str, ...]:
    """Return bound, value and how near they are, in words."""
    bound, value = certificate.upper_bound, certificate.value
    least = value * (1.0 - VALUE_RTOL)
    if Quantity.of(certificate.scenario).is_rate:
        most_rate, least_rate = max(0.0, math.log2(bound) + 1e-12), max(0.0, math.log2(least) - 1e-12)
        ends = _rounded(most_rate, ROUND_CEILING), _rounded(least_rate, ROUND_FLOOR)
        return tuple(f"{text} bits/s/Hz" for text in (*ends, _apart(most_rate - least_rate)))
    most_db = _rounded(10.0 * math.log10(bound) + 1e-12, ROUND_CEILING, digits=7)
    least_db = _rounded(10.0 * math.log10(value) - 1e-9, ROUND_FLOOR, digits=7)
    return (
        f"{_rounded(bound, ROUND_CEILING)} ({most_db} dB)",
        f"{_rounded(least, ROUND_FLOOR)} ({least_db} dB)",
        f"a relative {_apart(bound / least - 1.0)}",
    )


def _apart(number: float) -> str:
    """Return a distance between bound and value with three digits, rounded up."""
    return f"{float(Context(prec=3, rounding=ROUND_CEILING).create_decimal(number)):.2e}"


def _rounded(number: float, direction: str, digits: int = 9) -> str:
    """Return a number with so many decimals that claims no more than it does; in full if small or large."""
    if 0.0 < number < 1e-3 or number >= 1e9:
        return repr(number)
    return format(Decimal(number).quantize(Decimal(1).scaleb(-digits), rounding=direction), "f")
