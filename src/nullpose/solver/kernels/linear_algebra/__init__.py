"""Small vectors, symmetric forms and polynomials; the links of ground points in these terms."""
