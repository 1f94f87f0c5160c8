"""What produced a result."""

import json
import platform
from importlib.metadata import version

from nullpose.solver.provenance import provenance


def test_versions_and_seed_are_there() -> None:
    """The versions of what computed the numbers and the seed are named, ready for JSON."""
    record = provenance(7)
    assert record["nullpose"] == version("nullpose")
    assert record["numba"] == version("numba")
    assert record["numpy"] == version("numpy")
    assert record["python"] == platform.python_version()
    assert record["seed"] == 7
    assert json.loads(json.dumps(record, allow_nan=False)) == record
