"""What is measured, in the order of the report. To add one: README.md in the folder above."""

from benchmarks.workload import Workload
from benchmarks.workloads.certified import Certified
from benchmarks.workloads.certified_fields import CertifiedFields
from benchmarks.workloads.fields import Fields
from benchmarks.workloads.kernels import Kernels
from benchmarks.workloads.startup import Startup

WORKLOADS: tuple[Workload, ...] = (Fields(), Certified(), CertifiedFields(), Startup(), Kernels())

__all__ = ["WORKLOADS"]
