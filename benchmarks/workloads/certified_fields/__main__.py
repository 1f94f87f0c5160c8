"""The workload's solves, a line of JSON each, in a process that does nothing else."""

import json
import sys

from benchmarks.workloads.certified_fields.running import FULL, QUICK, run_all, warm_up

if __name__ == "__main__":
    if "--warm-up" in sys.argv:
        warm_up()
    else:
        for row in run_all(QUICK if "--quick" in sys.argv else FULL):
            print(json.dumps(row), flush=True)
