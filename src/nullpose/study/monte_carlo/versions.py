"""Which nullpose this is, so that a study is not put together by two."""

from __future__ import annotations

import hashlib
import platform
from functools import cache
from importlib.metadata import version
from pathlib import Path

_LIBRARIES = ("nullpose", "numpy", "scipy", "numba", "pyarrow", "distributed")


@cache
def fingerprint() -> str:
    """Return the version of nullpose with a digest of its code: two that agree give the same rows."""
    root = Path(__file__).parents[2]
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        digest.update(path.relative_to(root).as_posix().encode())
        digest.update(path.read_bytes().replace(b"\r\n", b"\n"))
    return f"{version('nullpose')}+{digest.hexdigest()[:12]}"


def versions() -> dict[str, str]:
    """Return the versions that a manifest records."""
    return {name: version(name) for name in _LIBRARIES} | {
        "python": platform.python_version(),
        "code": fingerprint(),
    }
