"""Random fields proved: boxes and seconds against the number of nodes and jammers."""

from benchmarks.workloads.certified_fields.certified_fields import CertifiedFields

__all__ = ["CertifiedFields"]
