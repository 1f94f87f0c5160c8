"""Whether each node gets the SINR that it requires, in words."""

from __future__ import annotations

from nullpose.physics import Link
from nullpose.solve import ArraySolution, Scheme, Solution

__all__ = ["requirement_words"]


def requirement_words(solution: Solution | ArraySolution) -> str:
    """Return whether the requirements are met and by how much, or which are missed; empty if there are none.

    That no pose meets them is said where the bound proves it.

    Args:
        solution: what was found.
    """
    nodes = solution.scenario.nodes
    links = [link for link, node in zip(solution.links, nodes, strict=True) if node.min_sinr_db is not None]
    if not links:
        return ""
    missed = [link for link in links if _spare_db(link) < 0.0]
    if not missed:
        least = min(links, key=_spare_db)
        who = "the requirement is met" if len(links) == 1 else "every requirement is met"
        return f"{who}; node {least.node}: {_spare_db(least):.2f} dB above what it requires"
    short = ", ".join(
        f"node {link.node}: {-_spare_db(link):.2f} dB below what it requires" for link in missed
    )
    bound = solution.objective.upper_bound
    hopeless = len(links) == len(nodes) and bound is not None and bound < 1.0
    which = "pose" if solution.scheme is Scheme.OPTIMUM else "pose of this case"
    proof = f"; proved: no {which} meets every requirement" if hopeless else ""
    return f"missed: {short}{proof}"


def _spare_db(link: Link) -> float:
    assert link.margin_db is not None, "a node that requires something has a margin"
    return link.margin_db
