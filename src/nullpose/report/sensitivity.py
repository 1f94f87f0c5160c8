"""What a pose loses if attitude, position or jammers are not as stated, as a table and in a sentence."""

from __future__ import annotations

import math

from nullpose.physics import interferer_gains
from nullpose.report.document import View, document, rows, table
from nullpose.report.numbers import number, with_unit
from nullpose.solver import ErrorSizes, Result
from nullpose.solver.refusal import refusal
from nullpose.solver.robust import RobustDetails

NULL_LOSS_DB = 3.0
"""A pose that loses more than this is said to depend on the errors."""

_NULL_GAIN = 0.1  # of the largest gain of a link: below it an interferer counts as in a null


def sensitivity_view(result: Result) -> View | None:
    """Set the smallest values found under errors as a table, with a sentence on a large loss."""
    if (found := result.sensitivity) is None:
        return None
    quantity, sizes = found.quantity, found.sizes
    jammers = f"each {result.scenario.interferer} by up to {sizes.jammers_m:g} m"
    kinds = {
        "attitude": f"attitude by up to {sizes.attitude_deg:g} deg",
        "position": f"position by up to {sizes.position_m:g} m",
        **({"jammers": jammers} if result.scenario.interferers else {}),
        "all": "all together",
    }
    nominal = quantity.in_unit(found.nominal)
    values = [quantity.in_unit(getattr(found, kind)) for kind in kinds]
    columns = {
        "error": list(kinds.values()),
        f"lowest {quantity.smallest_short} ({quantity.unit})": [number(value, quantity) for value in values],
        f"change ({quantity.unit})": [number(value - nominal, quantity) for value in values],
    }
    return document(
        table("If things are off (found by a search: the true lowest value can be lower)", rows(columns)),
        sensitivity_words(result),
    )


def sensitivity_caption(result: Result) -> str:
    """Write the smallest value found under all errors together, as a line for a figure."""
    if (found := result.sensitivity) is None:
        return ""
    value = with_unit(found.quantity.in_unit(found.all), found.quantity)
    return f"as low as {value} with errors up to {sizes_words(result, found.sizes)}"


def sizes_words(result: Result, sizes: ErrorSizes) -> str:
    """List the errors that are tried together, as in "1°, 1 m, jammers 10 m"."""
    scenario = result.scenario
    moved = f", {scenario.interferer}s {sizes.jammers_m:g} m" if scenario.interferers else ""
    return f"{sizes.attitude_deg:g}°, {sizes.position_m:g} m{moved}"


def sensitivity_words(result: Result) -> str | None:
    """Say that a pose loses much under errors, and towards whom its null is; None if it does not."""
    if (found := result.sensitivity) is None or not found.loss_db() > NULL_LOSS_DB:
        return None
    names = ", ".join(_nulled_names(result))
    pose = f"The pose stands on a null (towards {names})" if names else "The value depends on these errors"
    quantity, scenario = found.quantity, result.scenario
    loss = quantity.in_unit(found.nominal) - quantity.in_unit(found.all)
    words = with_unit(loss, quantity) if math.isfinite(loss) else "all of its value"
    sentence = f"{pose}: under these errors it can lose {words} or more."
    if isinstance(result.details, RobustDetails) or refusal(scenario, robust=True) is not None:
        return sentence
    errors = "such errors" if result.error_sizes == ErrorSizes() else "such errors, with the same --off"
    errors = "the errors that the scenario states" if scenario.is_uncertain else errors
    return f"{sentence} --robust finds the best pose for {errors}."


def _nulled_names(result: Result) -> list[str]:
    """List the jammers or eavesdroppers whose link is in a null of the antenna."""
    scenario, pose = result.scenario, result.pose
    gains = interferer_gains(scenario, pose.position_m, pose.orientation(scenario.antenna_record))
    return [
        name for name, gain in zip(scenario.of_interferers("names"), gains, strict=True) if gain < _NULL_GAIN
    ]
