"""What the methods are called in tables and figures, and how figures tell them apart."""

from __future__ import annotations

from benchmarks.provers import PROVERS
from benchmarks.workloads.certified.running import NULLPOSE

__all__ = ["LABELS", "LOOKS"]

LABELS = {NULLPOSE: "nullpose", **{prover.name: prover.label for prover in PROVERS}}

# (colour, line, marker) of each method in turn: Okabe and Ito's colours, told apart by marker too.
_CYCLE = (("#D55E00", "-", "s"), ("#009E73", "-", "^"), ("#CC79A7", "--", "D"), ("#555555", ":", "v"))
LOOKS = {
    NULLPOSE: ("#0a3fd6", "-", "o"),
    **{prover.name: _CYCLE[i % len(_CYCLE)] for i, prover in enumerate(PROVERS)},
}
