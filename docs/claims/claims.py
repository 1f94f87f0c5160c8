"""The paper's claims in its order: what each says, what counts as confirmed, and what is not proved of it."""

from __future__ import annotations

from claims import places, values
from claims.claim import Claim

CLAIMS = (
    Claim(
        id="weak-jamming-maximum-gain",
        claim="When the jamming is weak, the maximum-gain solution is the optimum.",
        source="section 4",
        method=f"Optimum less maximum gain (axis normalised) in dB, at most {values.COINCIDE_DB} dB at the "
        "weakest jamming swept and growing with the jamming; the level where it reaches that is bisected.",
        unproved="That the shortfall stays so small at the powers between those looked at; the level where "
        "it stops, a bisection between two of them; the exponent, taken from two values found.",
        measure=values.weak_jamming,
    ),
    Claim(
        id="strong-jamming-zero-interference",
        claim="When the jamming is strong, the zero-interference solution is the optimum.",
        source="section 4",
        method=f"Optimum less zero interference in dB, at most {values.COINCIDE_DB} dB at the strongest "
        "jamming swept and shrinking with the jamming; the level where it reaches that is bisected.",
        unproved="The exponent, taken from two values found; and any shortfall smaller than the gap of the "
        "proofs, which is that of the poses found.",
        measure=values.strong_jamming,
    ),
    Claim(
        id="zero-interference-constant",
        claim="The zero-interference solution performs the same whatever the jamming power.",
        source="section 4",
        method="Largest less smallest value over all swept levels, each solved afresh, at most "
        f"{values.CONSTANT_DB:g} dB.",
        unproved="That the position is the only best one: a bound is on the value, not on the place.",
        measure=values.zero_interference_constant,
    ),
    Claim(
        id="maximum-gain-null-at-jammer",
        claim="Under strong jamming the maximum-gain solution moves so that its null points at the jammer.",
        source="section 4",
        method="Angle between the antenna's axis and the direction to the jammer at the best maximum-gain "
        f"position (axis normalised), at most {places.POINTED_DEG:g} degree at every swept level from some "
        "level on, bisected.",
        unproved="The angles themselves, as a bound is on the value and not on the place: a pose elsewhere "
        "could come as near to it. The level from which they are so small, a bisection between two swept "
        "ones; and the powers between those looked at.",
        measure=places.null_at_jammer,
    ),
    Claim(
        id="vertical-above-jammer",
        claim="The vertical solution moves until it is directly above the jammer.",
        source="section 4",
        method=f"Horizontal distance from the jammer, at most {places.ABOVE_M} m at every swept level from "
        "some level on, bisected.",
        unproved="The distances themselves, as a bound is on the value and not on the place. The level of "
        "the jump, a bisection between two swept ones; and the powers between those looked at.",
        measure=places.above_jammer,
    ),
    Claim(
        id="maximum-gain-equidistant",
        claim="The best maximum-gain position is equally far from both nodes.",
        source="section 3.2",
        method="The best maximum-gain value (axis normalised) against the best one on the plane halfway "
        "between the nodes, each solved with a proof: the claim fails where the former is higher by more "
        f"than {places.BETTER_DB:g} dB. The level from which it is, is bisected.",
        unproved="The level from which it fails, a bisection between two swept ones, and the powers between "
        "those looked at; and what is said of eq. 3.5 as printed, which is searched and not bounded.",
        measure=places.equidistant,
    ),
    Claim(
        id="pose-optimisation-wins",
        claim="Optimising the full pose beats the under-actuated vehicle significantly, most under strong "
        "jamming.",
        source="section 4",
        method=f"Optimum less vertical in dB: above 0 everywhere, at least {values.SIGNIFICANT_DB:g} dB "
        f"wherever P_M/P >= {values.STRONG:g}, and there everywhere more than anywhere below P_M/P = "
        f"{values.WEAK:g}.",
        unproved="The levels from which something holds, each a bisection between two swept ones; that the "
        f"lead of {values.SIGNIFICANT_DB:g} dB, and maximum gain's over vertical, are kept at the powers "
        "between those looked at.",
        measure=values.pose_optimisation_wins,
    ),
    Claim(
        id="saturation-of-all-solutions",
        claim="All solutions saturate as the jamming grows stronger.",
        source="section 4",
        method=f"Change of each curve over the last decade of P_M/P, at most {values.FLAT_DB:g} dB; maximum "
        f"gain with the axis normalised. Saturation is dated from where the curve stays within "
        f"{values.NEAR_DB} dB of its last value.",
        unproved="What lies beyond the strongest jamming swept, but for the optimum and zero interference; "
        "what is said of eq. 3.5 as printed, which is searched and not bounded.",
        measure=values.saturation,
    ),
)
