"""All the paper's cases for one scenario side by side, those that do not apply with their reason."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from nullpose.objectives import Quantity
from nullpose.problem.schemes import Scheme
from nullpose.report.certainty import rigour_lines
from nullpose.report.document import View, beside, document, grouped, head, table
from nullpose.report.geometry import null_angle_rad
from nullpose.report.links import binding_nodes
from nullpose.report.numbers import bound_text
from nullpose.report.results import pose_cells, work_words
from nullpose.report.words import requirement_words
from nullpose.scenario import Eavesdropper, Jammer, Scenario
from nullpose.solver import Result, compare


@dataclass(frozen=True, slots=True, repr=False)
class Comparison:
    """What each scheme makes of a scenario.

    Args:
        scenario: what was solved.
        solutions: of the schemes that apply, in the paper's order.
        left_out: the other schemes, each with the reason why it does not apply.
    """

    scenario: Scenario
    solutions: tuple[Result, ...]
    left_out: tuple[tuple[Scheme, str], ...]

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C ended a proof."""
        return any(result.interrupted for result in self.solutions)

    def __repr__(self) -> str:
        absent = [f"left out: {scheme} ({reason})" for scheme, reason in self.left_out]
        return "; ".join([f"Comparison({self.scenario.name!r}: {len(self.solutions)} cases", *absent]) + ")"

    def to_dict(self) -> dict[str, object]:
        """Return the comparison as plain data, the scenario once for all cases."""
        found = [result.to_dict().items() for result in self.solutions]
        left_out = [
            {"scheme": scheme.value, "status": "not-applicable", "reason": reason}
            for scheme, reason in self.left_out
        ]
        return {
            "scenario": self.scenario.to_dict(),
            "cases": [{key: value for key, value in case if key != "scenario"} for case in found] + left_out,
            "provenance": dict(self.solutions[0].provenance) if self.solutions else {},
        }


def compare_all(
    scenario: Scenario, on_progress: Callable[[int, int], None] | None = None, **options: Any
) -> Comparison:
    """Solve a scenario in the paper's four cases, with options of :func:`nullpose.solver.compare`."""
    reasons = [(scheme, scheme.not_applicable(scenario)) for scheme in Scheme]
    left_out = tuple((scheme, reason) for scheme, reason in reasons if reason is not None)
    return Comparison(scenario, tuple(compare(scenario, on_progress=on_progress, **options)), left_out)


def comparison_view(comparison: Comparison) -> View:
    """Set the cases of a scenario side by side, a column each, and what is to be said of them below."""
    scenario, results = comparison.scenario, comparison.solutions
    quantity = Quantity.of(scenario)
    best = max((quantity.in_unit(result.objective.value) for result in results), default=math.nan)
    groups = [
        {result.label: _value_cells(result, best) for result in results},
        {result.label: pose_cells(result.pose) | _null_cells(result) for result in results},
        {result.label: _link_cells(result) for result in results},
    ]
    rows: list[Mapping[str, str]] = []
    for columns in groups:
        rows += [*beside(columns), {}]
    bold = [f"smallest {quantity.short} ({quantity.unit})"]
    return document(head(scenario.name), table("", rows, bold=bold), "\n".join(_lines(comparison)))


def _lines(comparison: Comparison) -> list[str]:
    """Write what there is to say: notes, requirements, cases that do not apply, how sure each is."""
    results, quantity = comparison.solutions, Quantity.of(comparison.scenario)
    labelled = [(result.label, result) for result in results]
    absent = [(scheme.label, f"not applicable: {reason}") for scheme, reason in comparison.left_out]
    starts = sum(result.stats.starts for result in results)
    boxes = sum(result.stats.boxes for result in results)
    status = {label: f"{each.status.message}{each.reason and f': {each.reason}'}" for label, each in labelled}
    return [
        *grouped((label, result.note) for label, result in labelled),
        *grouped((label, requirement_words(result)) for label, result in labelled),
        *grouped([*absent, *((label, "") for label, _ in labelled)]),
        *grouped(status.items()),
        *rigour_lines((label, result.rigour) for label, result in labelled),
        f"{work_words(starts, boxes)} (all cases together)",
        f"* worst node: the {quantity.smallest} is here",
        "Each upper bound holds for the poses that its scheme allows.",
        "All cases use one dipole on this file's vehicle. Other vehicles and arrays: compare --airframes",
    ]


def _value_cells(result: Result, best: float) -> dict[str, str]:
    objective, quantity = result.objective, result.objective.quantity
    value, smallest = quantity.in_unit(objective.value), f"smallest {quantity.short}"
    return {
        f"{smallest} ({quantity.unit})": f"{value:.7f}",
        f"upper bound ({quantity.unit})": bound_text(objective, 7),
        **({} if quantity.is_rate else {smallest: f"{objective.value:.7g}"}),
        f"below the best ({quantity.unit})": f"{best - value:z.4f}",
    }


def _null_cells(result: Result) -> dict[str, str]:
    """Write how far the null is off what it is for."""
    points: list[Jammer | Eavesdropper] = [*result.scenario.eavesdroppers]
    if not result.objective.quantity.is_rate:
        points += result.scenario.jammers
    angles_rad = [(point.name, null_angle_rad(result.pose, point.position_m)) for point in points]
    return {f"axis to {name} (deg)": f"{math.degrees(angle_rad):.2f}" for name, angle_rad in angles_rad}


def _link_cells(result: Result) -> dict[str, str]:
    """Write each node's ratio, and its SINR, margin or rate with a mark where the node binds."""
    quantity, links, binding = result.objective.quantity, result.links, binding_nodes(result)
    ratios = {f"{quantity.ratio} {link.node} (dB)": f"{link.sinr_db:.4f} " for link in links}
    return ratios | {
        f"{quantity.short} {link.node} ({quantity.unit})": (
            f"{quantity.in_unit(quantity.at(link)):.4f}{'*' if link.node in binding else ' '}"
        )
        for link in links
    }
