"""Results in the formats of other programs."""

from nullpose.report.export.geojson import require_origin, solution_geojson, write_geojson

__all__ = ["require_origin", "solution_geojson", "write_geojson"]
