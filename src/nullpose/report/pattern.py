"""What a file of a radiation pattern holds, as a table and in words."""

from __future__ import annotations

import math

from nullpose.antenna.summary import PatternSummary
from nullpose.report.document import View, document, head, pairs
from nullpose.report.numbers import fixed


def pattern_view(summary: PatternSummary) -> View:
    """Return what was read of a pattern, and what a user should know of how.

    Args:
        summary: of the pattern.
    """
    table, largest_m = summary.table, summary.largest_m
    known = "gains only" if table.field is None else "with phases"
    rows = [
        ("quantity", table.quantity),
        ("frequency", None if table.frequency_hz is None else f"{table.frequency_hz / 1e6:.7g} MHz"),
        ("peak", f"{fixed(summary.peak_dbi, 2)} dBi, at {_place(summary.peak_deg)}"),
        ("average", f"{fixed(summary.mean_db, 2)} dB over the sphere"),
        ("deepest null", _null_text(summary)),
        ("ripple round z", f"{fixed(summary.ripple_db, 2)} dB, at theta 90"),
        (
            "polarisation",
            summary.polarisation if table.field is None else f"{summary.polarisation}, at the peak",
        ),
        ("degree needed", _degree_text(summary)),
        ("grid", f"steps of {summary.step_deg:g} degrees, {known}"),
        (
            "",
            None if largest_m is None else f"fine enough for antennas within {largest_m:.2g} m of the origin",
        ),
    ]
    return document(head(table.source), pairs("", rows), *table.notes)


def _null_text(summary: PatternSummary) -> str:
    if summary.null_db == 0.0:
        return "none"
    depth = f"{fixed(summary.null_db, 1)} dB below the peak" if math.isfinite(summary.null_db) else "exact"
    return f"{depth}, at {_place(summary.null_deg)}"


def _degree_text(summary: PatternSummary) -> str:
    most = summary.supported_degree
    return f"more than {most}" if summary.degree is None else f"{summary.degree}; the grid resolves {most}"


def _place(angles_deg: tuple[float, float]) -> str:
    theta_deg, phi_deg = angles_deg
    return f"theta {theta_deg:g}" if theta_deg in (0.0, 180.0) else f"theta {theta_deg:g}, phi {phi_deg:g}"
