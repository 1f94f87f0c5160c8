"""What produced a result."""

from __future__ import annotations

import platform
from functools import cache

import numpy as np

from nullpose.version import __version__


def provenance(seed: int) -> dict[str, object]:
    """Return the versions and the seed behind a result.

    Args:
        seed: the seed of the search.
    """
    return _versions() | {"seed": seed}


@cache
def _versions() -> dict[str, object]:
    import numba

    return {
        "nullpose": __version__,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "numba": numba.__version__,
        "machine": platform.machine(),
        "system": platform.system(),
    }
