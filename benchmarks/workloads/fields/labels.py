"""What the methods are called in tables and figures, and how figures tell them apart."""

from __future__ import annotations

from benchmarks.peers import PEERS
from benchmarks.workloads.fields.running import NULLPOSE, PROVED, REFERENCE

__all__ = ["LABELS", "LOOKS"]

LABELS = {
    NULLPOSE: "nullpose, search alone",
    PROVED: "nullpose, certified",
    REFERENCE: "reference search",
    **{peer.name: peer.label for peer in PEERS},
}

# (colour, line, marker) of each method in turn: Okabe and Ito's colours, told apart by marker too.
_CYCLE = (
    ("#D55E00", "-", "s"),
    ("#009E73", "--", "^"),
    ("#CC79A7", "-", "D"),
    ("#8a6d00", "--", "v"),
    ("#56B4E9", "-", "P"),
    ("#555555", "--", "X"),
    ("#111111", ":", "*"),
)
LOOKS = {
    NULLPOSE: ("#0a3fd6", "-", "o"),
    PROVED: ("#0a3fd6", "--", "h"),
    **{peer.name: _CYCLE[i % len(_CYCLE)] for i, peer in enumerate(PEERS)},
}
