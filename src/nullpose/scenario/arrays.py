"""Arrays of a scenario's numbers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


def read_only(values: ArrayLike, shape: Sequence[int]) -> NDArray[np.float64]:
    """Returns the values as a float64 array of the given shape that refuses to be written to."""
    array = np.array(values, dtype=np.float64).reshape(shape)
    array.flags.writeable = False
    return array
