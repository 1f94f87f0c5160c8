"""What a file of a radiation pattern holds, as a table and in words."""

from __future__ import annotations

import math

from nullpose.antenna.summary import PatternSummary
from nullpose.report.document import View, document, head, pairs


def pattern_view(summary: PatternSummary) -> View:
    """Set what was read of a pattern, with notes on how."""
    table, largest_m = summary.table, summary.largest_m
    field = "gains only" if table.field is None else "with phases"
    rows = [
        ("quantity", table.quantity),
        ("frequency", None if table.frequency_hz is None else f"{table.frequency_hz / 1e6:.7g} MHz"),
        ("peak", f"{summary.peak_dbi:z.2f} dBi, at {_place(summary.peak_deg)}"),
        ("average", f"{summary.mean_db:z.2f} dB over the sphere"),
        ("deepest null", _null_text(summary.null_db, summary.null_deg)),
        ("null used", _null_text(summary.used_null_db, summary.used_null_deg)),
        ("error of the fit", _error_text(summary)),
        ("ripple round z", f"{summary.ripple_db:z.2f} dB, at theta 90"),
        (
            "polarisation",
            summary.polarisation if table.field is None else f"{summary.polarisation}, at the peak",
        ),
        ("degree used", f"{summary.degree}; the grid resolves {summary.supported_degree}"),
        ("grid", f"steps of {summary.step_deg:g} degrees, {field}"),
        ("", f"fine enough for antennas within {largest_m:.2g} m of the origin" if largest_m else None),
    ]
    return document(head(table.source), pairs("", rows), *table.notes)


def _null_text(depth_db: float, place_deg: tuple[float, float]) -> str:
    if depth_db == 0.0:
        return "none"
    depth = f"{depth_db:z.1f} dB below the peak" if math.isfinite(depth_db) else "exact"
    return f"{depth}, at {_place(place_deg)}"


def _error_text(summary: PatternSummary) -> str:
    null_db = summary.null_error_db
    at_null = f", {null_db:z.2f} dB at the null" if math.isfinite(null_db) else ""
    return (
        f"{summary.error_10_db:z.2f} dB within 10 dB of the peak, {summary.error_20_db:z.2f} dB "
        f"within 20 dB, at {_place(summary.error_deg)}{at_null}"
    )


def _place(angles_deg: tuple[float, float]) -> str:
    theta_deg, phi_deg = (round(angle_deg, 1) for angle_deg in angles_deg)
    return f"theta {theta_deg:g}" if theta_deg in (0.0, 180.0) else f"theta {theta_deg:g}, phi {phi_deg:g}"
