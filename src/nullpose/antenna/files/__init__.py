"""Files of radiation patterns: seven formats, read into one table over the sphere."""

from __future__ import annotations

from nullpose.antenna.files.reading import FORMATS, read_pattern, read_profile

__all__ = ["FORMATS", "read_pattern", "read_profile"]
