"""Search and proof of one problem: the best pose over one axis field, or over several."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

from nullpose.errors import RequirementError
from nullpose.physics.decibel import to_db
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family
from nullpose.solver.compiling import compile_search, limit_clock, precompile
from nullpose.solver.multistart import Incumbent, climb, multistart, search_settings
from nullpose.solver.options import SolveOptions
from nullpose.solver.proof import Proof, prove

_ALL_MET = -1e3  # logarithms of a mean below this are of poses that miss a requirement
_UPRIGHT = 0.99  # the least u_z^2 of axes that are all about vertical


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Outcome:
    """The best pose over all axis fields, and what was proved about each.

    Args:
        incumbent: the best pose.
        chosen: index of the axis field that it belongs to.
        proofs: one for each axis field, in order; empty if none was asked for, or if one has too many leaves
            for a certificate.
        upper_bound: no pose under any of the fields exceeds this; None if nothing is proved.
        reason: why the target gap was not reached, or not aimed at; empty if it was.
        cells: what was examined by a proof that leaves no leaves.
    """

    incumbent: Incumbent
    chosen: int = 0
    proofs: tuple[Proof, ...] = ()
    upper_bound: float | None = None
    reason: str = ""
    cells: int = 0

    @property
    def nodes(self) -> int:
        """Nodes examined by all proofs."""
        return self.cells + sum(proof.nodes for proof in self.proofs)


def solve_and_prove(
    family: Family,
    fields: Sequence[AxisField],
    options: SolveOptions,
    *,
    incumbent: Incumbent | None = None,
    bound: float = math.inf,
    last: Proof | None = None,
    searches_again: bool = True,
) -> Outcome:
    """Return the best pose over the axis fields, with a proof if one is asked for.

    Every field is searched; then it is proved of each that it does not beat the best of all. The search
    before a proof is light; where the proof does not close at once, the one without a proof is made, too.

    Args:
        family: the ratios and their domain.
        fields: the axis fields, one or more.
        options: what is asked for, its gap stated.
        incumbent: a pose under the only field, in place of a search.
        bound: known before of more axes than the fields have.
        last: a proof of almost the same family under the only field, to begin with.
        searches_again: whether the search without a proof may be made.

    Raises:
        SolveError: no pose reaches every node, or what it requires.
    """
    # compiling must not count against the time limit
    (precompile if options.certify else compile_search)()
    began = limit_clock()
    searches: list[Incumbent] = []

    def searched(field: AxisField, proof_follows: bool) -> Incumbent:
        settings = search_settings(proof_follows, field, len(family.ratios.shares) > 0)
        found = multistart(
            family, field, seed=options.seed, settings=settings, deadline=began + options.time_limit_s
        )
        if field.is_free and _UPRIGHT < field.band[0] < field.band[1] == 1.0 and not proof_follows:
            upright = searched(AxisField.vertical(), False)  # a needle that a band's search may miss
            climbed = climb(family, field, upright.position_m, upright.axis)
            found = max(found, climbed, key=lambda each: each.log_value)
        searches.append(found)
        return searches[-1]

    each = [incumbent or searched(field, options.certify) for field in fields]
    chosen = max(range(len(each)), key=lambda i: each[i].log_value)
    if each[chosen].log_value < _ALL_MET:
        chosen, each[chosen] = _within_requirements(family, fields, options)
    best = each[chosen]
    proofs: list[Proof] = []
    reason = ""
    least = 0.0 if options.of_rate else -math.inf  # a rate is never below zero
    for i, field in enumerate(fields if options.certify else ()):
        # the level to exclude is that of the best of all; where to look for better poses is this field's
        level, start = max(best.log_value, least), each[i]
        proof = prove(
            family,
            field,
            start if start.log_value == level else replace(start, log_value=level),
            options,
            began=began,
            nodes=sum(p.nodes for p in proofs),
            bound=bound,
            search=partial(searched, field, False) if searches_again else None,
            last=last,
        )
        proofs.append(proof)
        reason = reason or proof.reason
        if proof.incumbent.log_value > best.log_value:
            best, chosen = proof.incumbent, i
    if searches:
        best = replace(
            best,
            starts=sum(found.starts for found in searches),
            evaluations=sum(found.evaluations for found in searches),
        )
    has_leaves = all(len(proof.leaves) for proof in proofs)
    return Outcome(
        incumbent=best,
        chosen=chosen,
        proofs=tuple(proofs) if has_leaves else (),
        cells=0 if has_leaves else sum(proof.nodes for proof in proofs),
        upper_bound=max(p.upper_bound for p in proofs) if proofs else None,
        reason=reason,
    )


def _within_requirements(
    family: Family, fields: Sequence[AxisField], options: SolveOptions
) -> tuple[int, Incumbent]:
    """Return the index of a field and a pose under it that meets the requirements of a mean's ratios.

    Raises:
        RequirementError: there is none, or none was found.
    """
    nearest = solve_and_prove(family.required_ratios, fields, replace(options, of_rate=False))
    found = nearest.incumbent
    if found.log_value >= 0.0:
        return nearest.chosen, climb(family, fields[nearest.chosen], found.position_m, found.axis)
    missed_db = -to_db(math.exp(found.log_value))
    most = math.inf if nearest.upper_bound is None else nearest.upper_bound
    proved = f", and proved: every pose misses one by {-to_db(most):.6g} dB or more" if most < 1.0 else ""
    raise RequirementError(
        "nodes.min_sinr_db: no pose was found that meets every requirement; the best misses one by "
        f"{missed_db:.6g} dB{proved}. Lower min_sinr_db by as much, or widen the airspace"
    )
