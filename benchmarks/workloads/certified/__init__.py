"""The paper's scene proved: nullpose beside global solvers, from weak jamming to strong."""

from benchmarks.workloads.certified.certified import Certified

__all__ = ["Certified"]
