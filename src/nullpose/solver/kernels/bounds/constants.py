"""The numbers of the lemmas, rounded up. Each is derived in docs/proofs.md, and again in its test.

They bound derivatives along a unit direction, times powers of distances: a is the least distance of a point
to the box, rho that of the point that a frame turns towards. The certificate has its own copy.
"""

CONSTANT_FORM_BEND = 2.4143  # lemma 2: of a constant form in a turning frame, over rho^2: 1 + sqrt(2)
DIRECTION_BEND = 1.1548  # second derivative of the direction to a point, over rho^2: 2 / sqrt(3)
DIRECTION_THIRD = 2.31  # lemma 5: third derivative of d / (d.d0), over y^3, where d is d0: 6 cos^2 sin
VECTOR_SLOPE, VECTOR_BEND, VECTOR_THIRD = 1.1548, 3.0, 9.89  # lemma 5: of a link vector, over a^2, a^3, a^4
VECTOR_SQUARE_BEND = 8.67  # second derivative of a link vector's square, over a^4: 2 (4 / 3 + 3)
ROUNDING = 2e-14  # of a sum, relative to its terms: a hundred units in the last place
