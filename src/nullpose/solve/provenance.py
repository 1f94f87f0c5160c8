"""What produced a result."""

from __future__ import annotations

import platform
from functools import cache
from importlib.metadata import version

__all__ = ["provenance"]


def provenance(seed: int) -> dict[str, object]:
    """Return the versions and the seed behind a result.

    Args:
        seed: the seed of the search.
    """
    return _versions() | {"seed": seed}


@cache
def _versions() -> dict[str, object]:
    return {
        "nullpose": version("nullpose"),
        "python": platform.python_version(),
        "numpy": version("numpy"),
        "numba": version("numba"),
        "machine": platform.machine(),
        "system": platform.system(),
    }
