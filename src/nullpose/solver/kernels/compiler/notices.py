"""What a user is told once: why kernels are slower to begin with than they could be."""

from __future__ import annotations

import logging
from functools import cache

UNCACHED = (
    "Each command compiles them again. To keep them, set NUMBA_CACHE_DIR to a folder with 20 MB of room."
)
"""What follows where no folder can keep kernels."""

OTHER_NUMBA = (
    "nullpose is made for numba 0.61 to 0.68, and this is numba {}: the kernels are compiled in its own way, "
    "which takes longer."
)
"""What is said of another numba."""


@cache
def warn_once(text: str) -> None:
    """Log a warning, on standard error unless logging is set up otherwise, the first time only.

    Args:
        text: what is the matter.
    """
    logging.getLogger("nullpose").warning(text)
