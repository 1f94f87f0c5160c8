"""All the paper's cases for one scenario, those that do not apply with their reason."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from nullpose.scenario import Scenario
from nullpose.solve import NODE_LIMIT, PAPER_SCHEMES, TIME_LIMIT_S, Scheme, Solution, compare

__all__ = ["Comparison", "compare_all"]


@dataclass(frozen=True, slots=True)
class Comparison:
    """What each scheme makes of a scenario.

    Args:
        scenario: what was solved.
        solutions: of the schemes that apply, in the paper's order.
        left_out: the other schemes, each with the reason why it does not apply.
    """

    scenario: Scenario
    solutions: tuple[Solution, ...]
    left_out: tuple[tuple[Scheme, str], ...]

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C ended a proof."""
        return any(solution.interrupted for solution in self.solutions)

    def to_dict(self) -> dict[str, object]:
        """Return the comparison as plain data, the scenario once for all cases."""
        cases: list[dict[str, object]] = []
        for solution in self.solutions:
            case = solution.to_dict()
            del case["scenario"]
            cases.append(case)
        cases += [
            {"scheme": scheme.value, "status": "not-applicable", "reason": reason}
            for scheme, reason in self.left_out
        ]
        return {
            "scenario": self.scenario.to_dict(),
            "cases": cases,
            "provenance": dict(self.solutions[0].provenance) if self.solutions else {},
        }


def compare_all(
    scenario: Scenario,
    *,
    gap: float | None = None,
    time_limit_s: float = TIME_LIMIT_S,
    node_limit: int = NODE_LIMIT,
    certify: bool = True,
    seed: int = 0,
    on_progress: Callable[[int, int], None] | None = None,
) -> Comparison:
    """Return the four cases of the paper for one scenario.

    Args:
        scenario: nodes, jammers, receiver and airspace.
        gap: relative gap at which each proof is done; without it, by the number of nodes.
        time_limit_s: seconds after which each proof stops.
        node_limit: boxes after which each proof stops.
        certify: whether to prove anything.
        seed: the random seed of every solve.
        on_progress: called after each solve with how many are done and how many there are.
    """
    reasons = [(scheme, scheme.not_applicable(scenario)) for scheme in PAPER_SCHEMES]
    return Comparison(
        scenario=scenario,
        solutions=compare(
            scenario,
            gap=gap,
            time_limit_s=time_limit_s,
            node_limit=node_limit,
            certify=certify,
            seed=seed,
            on_progress=on_progress,
        ),
        left_out=tuple((scheme, reason) for scheme, reason in reasons if reason is not None),
    )
