"""What has to be set before NumPy and Numba are imported, so that times are fair and kernels are fresh."""

from __future__ import annotations

import hashlib
import os
import sys
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

__all__ = ["ROOT", "prepare"]

ROOT = Path(__file__).parents[1]

_ONE_THREAD = (
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "VECLIB_MAXIMUM_THREADS",
    "NUMBA_NUM_THREADS",
)


def prepare(scratch: Path) -> Path:
    """Return the kernel cache of this run, after pinning every library to one thread.

    Numba reuses a cached kernel when that kernel's own file is unchanged, even if a kernel that it calls has
    changed. The cache is therefore keyed by the text of all kernels: what is timed is what the source says.

    Args:
        scratch: a folder for caches, made if need be.
    """
    for name in _ONE_THREAD:
        os.environ[name] = "1"
    os.environ["MPLBACKEND"] = "Agg"
    cache = scratch / "kernels" / _kernels_digest()
    cache.mkdir(parents=True, exist_ok=True)
    os.environ["NUMBA_CACHE_DIR"] = str(cache)
    return cache


def _kernels_digest() -> str:
    spec = find_spec("nullpose")
    package = Path(spec.origin).parent if spec is not None and spec.origin is not None else ROOT
    sha = hashlib.sha256(f"{sys.version} {version('numba')} {version('llvmlite')}".encode())
    for source in sorted((package / "solve" / "kernels").rglob("*.py")):
        sha.update(str(source).encode() + source.read_bytes())
    return sha.hexdigest()[:16]
