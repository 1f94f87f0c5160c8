"""Numbers of the lemmas, rounded up; docs/proofs.md derives each, and so does a test.

The solver has its own copies. Powers of distances are left to the place of use.
"""

from __future__ import annotations

import math

_UP = 1.0 + 1e-12

# A direction to a point, seen from a position that moves along a unit direction.
DIRECTION_BEND = 2.0 / math.sqrt(3.0) * _UP
"""The most that its frame's second derivative does to a unit vector: root of 4 x - 3 x^2, x = 2/3."""
CONSTANT_SWING = (1.0 + math.sqrt(2.0)) * _UP
"""The second derivative of a constant form in a turning frame, over the spread of its eigenvalues."""

# The derivatives of a link vector along a unit direction (lemma 5).
VECTOR_SLOPE = 2.0 / math.sqrt(3.0) * _UP
VECTOR_BEND = 3.0 * _UP
VECTOR_THIRD = 9.89 * _UP

SPREAD_OVER_NORM = math.sqrt(2.0) * _UP
"""The spread of a symmetric form's eigenvalues, over its Frobenius norm."""
