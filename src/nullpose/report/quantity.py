"""Value and bound of an objective in words, with the digits that they need."""

from __future__ import annotations

import math

from nullpose.solve import Objective

__all__ = ["bound_text", "bound_words", "value_words"]


def value_words(objective: Objective) -> str:
    """Return the objective's value in words, as in ``smallest SINR 0.98 dB (1.25)``.

    Args:
        objective: value and bound.
    """
    if objective.quantity.is_rate:
        return f"{objective.quantity.smallest} {objective.value:.7g} bits/s/Hz"
    return f"{objective.quantity.smallest} {objective.value_db:.7g} dB ({objective.value:.7g})"


def bound_words(objective: Objective) -> str:
    """Return the bound and the gap in words, empty if nothing is proved.

    Args:
        objective: value and bound.
    """
    if objective.upper_bound is None or objective.relative_gap is None:
        return ""
    unit = objective.quantity.unit
    return f"at most {bound_text(objective)} {unit} (relative gap {objective.relative_gap:.1e})"


def bound_text(objective: Objective, digits: int = 0) -> str:
    """Return the bound in its unit, rounded up, with the decimals that tell it from the value, or so many.

    Args:
        objective: value and bound.
        digits: decimals; 0 to choose.
    """
    assert objective.upper_bound is not None
    quantity = objective.quantity
    bound = quantity.in_unit(objective.upper_bound)
    if not digits:
        apart = max(bound - quantity.in_unit(objective.value), 1e-12)
        digits = min(12, max(2, math.ceil(-math.log10(apart)) + 1))
    return f"{math.ceil(bound * 10**digits) / 10**digits:.{digits}f}"
