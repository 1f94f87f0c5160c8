"""The schemes: the paper's four cases, and one of them as printed."""

from __future__ import annotations

from enum import StrEnum

from nullpose.errors import UsageError
from nullpose.scenario import Scenario

__all__ = ["PAPER_SCHEMES", "Scheme", "as_scheme", "not_applicable", "require_applicable"]


class Scheme(StrEnum):
    """How the pose is chosen (paper section 4)."""

    OPTIMUM = "optimum"
    ZERO_INTERFERENCE = "zero-interference"
    MAXIMUM_GAIN = "maximum-gain"
    VERTICAL = "vertical"
    MAXIMUM_GAIN_PRINTED = "maximum-gain-printed"

    @property
    def label(self) -> str:
        """The scheme's name for tables and figures."""
        return _LABELS[self]


_LABELS = {
    Scheme.OPTIMUM: "Optimum",
    Scheme.ZERO_INTERFERENCE: "Zero interference",
    Scheme.MAXIMUM_GAIN: "Maximum gain",
    Scheme.VERTICAL: "Vertical",
    Scheme.MAXIMUM_GAIN_PRINTED: "Maximum gain, as printed",
}

PAPER_SCHEMES = (Scheme.OPTIMUM, Scheme.ZERO_INTERFERENCE, Scheme.MAXIMUM_GAIN, Scheme.VERTICAL)


def as_scheme(name: str) -> Scheme:
    """Return the scheme of a name.

    Raises:
        UsageError: there is no such scheme.
    """
    try:
        return Scheme(name)
    except ValueError:
        known = ", ".join(Scheme)
        raise UsageError(f"scheme: given {name!r}; allowed: {known}") from None


def not_applicable(scenario: Scenario, scheme: Scheme) -> str | None:
    """Return why a scheme has no meaning for a scenario, or None if it has.

    Args:
        scenario: the scenario.
        scheme: the scheme.
    """
    secret, tied = scenario.objective == "secrecy-rate", scenario.axis_band != (0.0, 1.0)
    if secret and scheme not in (Scheme.OPTIMUM, Scheme.VERTICAL):
        return "the paper states it for a drone that receives, and here it transmits (secrecy rate)"
    if tied and scheme is Scheme.VERTICAL and scenario.axis_band[1] < 1.0:
        return "the airframe does not reach a vertical antenna"
    if tied and scheme not in (Scheme.OPTIMUM, Scheme.VERTICAL):
        return "it may ask for any antenna axis, and the airframe does not reach every one"
    if scheme is Scheme.ZERO_INTERFERENCE and not scenario.jammers:
        return "zero interference needs a jammer to point its null at; the scenario has none"
    if scheme is Scheme.MAXIMUM_GAIN_PRINTED and scenario.has_margins:
        return "eq. 3.5 as printed knows no weights or requirements"
    if scheme is Scheme.MAXIMUM_GAIN_PRINTED and len(scenario.nodes) != 2:
        return f"eq. 3.5 as printed is for two nodes; the scenario has {len(scenario.nodes)}"
    return None


def require_applicable(scenario: Scenario, scheme: Scheme) -> None:
    """Raise a UsageError if a scheme has no meaning for a scenario."""
    reason = not_applicable(scenario, scheme)
    if reason is not None:
        raise UsageError(f"scheme {scheme.value}: {reason}; try another scheme")
