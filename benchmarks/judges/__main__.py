"""Ask every judge, and write what they say: ``python -m benchmarks.judges``."""

from __future__ import annotations

import sys

from benchmarks.judges import ray_tracer, wires
from benchmarks.judges.verdict import PAGE, Verdict, page


def main() -> int:
    """Return 0 if no judge disagrees, 1 if one does."""
    found: list[Verdict] = []
    for judge in (wires, ray_tracer):
        for verdict in judge.verdicts():
            print(verdict.row(), flush=True)
            found.append(verdict)
    PAGE.write_text(page(found), encoding="utf-8")
    print(f"Wrote {PAGE.name}")
    return 0 if all(verdict.agrees for verdict in found) else 1


if __name__ == "__main__":
    sys.exit(main())
