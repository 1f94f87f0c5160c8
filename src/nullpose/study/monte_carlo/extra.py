"""The packages that studies need beyond those of nullpose itself."""

from __future__ import annotations

import sys
from importlib.util import find_spec

from nullpose.errors import UsageError

_PACKAGES = ("pyarrow", "pandas", "xarray", "dask", "distributed", "cryptography")


def require_extra() -> None:
    """Raise a UsageError that says how to install what studies need, unless all of it is there.

    Raises:
        UsageError: a package is missing.
    """
    missing = [name for name in _PACKAGES if find_spec(name) is None]
    if missing:
        raise UsageError(
            f"a study needs {', '.join(missing)}, not installed here; run: {sys.executable} -m pip install "
            "'nullpose[study]'"
        )
