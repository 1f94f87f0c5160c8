"""Files of radiation patterns, one format each, and what is refused of them."""

from nullpose.antenna.files.reading import FORMATS, read_pattern, read_profile

__all__ = ["FORMATS", "read_pattern", "read_profile"]
