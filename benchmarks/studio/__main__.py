"""Runs one of the two as ``python -m benchmarks.studio latency`` or ``python -m benchmarks.studio soak``."""

import argparse
import json

from benchmarks.studio.latency import latency
from benchmarks.studio.soak import soak

parser = argparse.ArgumentParser(prog="python -m benchmarks.studio", description=__doc__)
parser.add_argument("what", choices=("latency", "soak"))
parser.add_argument("--steps", type=int, default=60, help="of a drag")
parser.add_argument("--minutes", type=float, default=30.0, help="of random editing")
parser.add_argument("--seed", type=int, default=0, help="of random editing")
arguments = parser.parse_args()
if arguments.what == "latency":
    print(json.dumps(latency(arguments.steps), indent=2))
else:
    print(json.dumps(soak(arguments.minutes, arguments.seed), indent=2))
