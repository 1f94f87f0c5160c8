"""What produced a result."""

from __future__ import annotations

import platform
from importlib.metadata import version

__all__ = ["provenance"]


def provenance(seed: int) -> dict[str, object]:
    """Return the versions and the seed behind a result.

    Args:
        seed: the seed of the search.
    """
    return {
        "nullpose": version("nullpose"),
        "python": platform.python_version(),
        "numpy": version("numpy"),
        "numba": version("numba"),
        "machine": platform.machine(),
        "system": platform.system(),
        "seed": seed,
    }
