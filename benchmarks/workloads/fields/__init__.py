"""Random fields: does `solve` find the best optimum, and how long does it take beside general solvers?"""

from benchmarks.workloads.fields.fields import Fields

__all__ = ["Fields"]
