"""Runs one of the two as ``python -m benchmarks.studio latency`` or ``python -m benchmarks.studio soak``."""

import argparse
import json

from benchmarks.studio.latency import latency
from benchmarks.studio.soak import soak

parser = argparse.ArgumentParser(prog="python -m benchmarks.studio", description=__doc__)
parser.add_argument("what", choices=("latency", "soak"))
parser.add_argument("--steps", type=int, default=0, help="without it 60 and 36000 (an hour at 10 Hz)")
parser.add_argument("--minutes", type=float, default=20.0, help="when a soak ends though steps are left")
arguments = parser.parse_args()
if arguments.what == "latency":
    print(json.dumps(latency(arguments.steps or 60), indent=2))
else:
    print(json.dumps(soak(arguments.steps or 36_000, arguments.minutes), indent=2))
