"""What a run ran on, as plain data for the report."""

from __future__ import annotations

import os
import platform
import subprocess
from collections.abc import Iterable
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from benchmarks.environment import ROOT

__all__ = ["describe_machine", "load_average"]

PACKAGES = ("nullpose", "numpy", "scipy", "numba", "llvmlite", "cma", "pyscipopt", "maingopy")


def describe_machine() -> dict[str, str]:
    """Return the machine, the system and the versions, as pairs of name and text."""
    return {
        "date (UTC)": datetime.now(UTC).date().isoformat(),
        "source": _revision(),
        "processor": _processor(),
        "cores": f"{os.cpu_count()}; one thread, but for proofs of more than 20,000 boxes",
        "memory": _memory(),
        "system": f"{platform.system()}, {platform.machine()}",
        "Python": f"{platform.python_implementation()} {platform.python_version()}",
        **dict(_versions(PACKAGES)),
    }


def load_average() -> float:
    """Return how many processes wanted a core over the last minute, NaN where the system does not say."""
    return os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")


def _versions(packages: Iterable[str]) -> Iterable[tuple[str, str]]:
    for package in packages:
        try:
            yield package, version(package)
        except PackageNotFoundError:
            yield package, "not installed"


def _processor() -> str:
    information = Path("/proc/cpuinfo")
    lines = information.read_text(encoding="utf-8").splitlines() if information.is_file() else []
    facts = {key.strip(): value.strip() for key, _, value in (line.partition(":") for line in lines)}
    if "model name" not in facts:
        return platform.processor() or "unknown"
    clock = f", {float(facts['cpu MHz']) / 1000:.2f} GHz" if "cpu MHz" in facts else ""
    return f"{facts['model name']}{clock}"


def _memory() -> str:
    try:
        size = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return "unknown"
    return f"{size / 2**30:.0f} GiB"


def _revision() -> str:
    """Return the commit, and whether the source or the benchmark differs from it."""
    paths = ("src", "benchmarks/*.py", "benchmarks/**/*.py")
    try:
        commit = _git("rev-parse", "--short=10", "HEAD")
        changed = _git("status", "--porcelain", "--", *paths)
    except (OSError, subprocess.CalledProcessError):
        return "not a git clone"
    return f"commit {commit}, with changes since" if changed else f"commit {commit}"


def _git(*arguments: str) -> str:
    done = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=True)
    return done.stdout.strip()
