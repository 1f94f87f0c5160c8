"""What was read of a pattern file, as a table."""

from __future__ import annotations

import math

from nullpose.antenna.summary import PatternSummary
from nullpose.report.document import View, document, head, pairs


def pattern_view(summary: PatternSummary) -> View:
    """Return a pattern's numbers.

    Args:
        summary: of a file.
    """
    depth = (
        f"{summary.null_depth_db:.1f} dB below the peak" if math.isfinite(summary.null_depth_db) else "exact"
    )
    enough = "enough" if summary.step_deg <= summary.coarsest_deg else "coarse: look at the cuts"
    frequency = "not told" if summary.frequency_hz is None else f"{summary.frequency_hz / 1e6:.6g} MHz"
    rows = [
        ("quantity", summary.quantity),
        ("frequency", frequency),
        ("peak", f"{summary.peak_dbi:.2f} dBi at {_place(summary.peak_at_deg)}"),
        ("mean gain", f"{summary.mean_gain_db:.2f} dB (0 without losses)"),
        ("deepest null", f"{depth}, at {_place(summary.null_at_deg)}"),
        ("ripple at theta 90", f"{summary.ripple_db:.2f} dB"),
        ("polarisation", summary.polarisation),
        ("degree", f"{summary.degree} (spherical harmonics)"),
        ("grid step", f"{summary.step_deg:g} deg ({enough})"),
        ("axes", "x forward, y left, z up; theta from z, phi from x towards y, right-handed"),
    ]
    return document(head(summary.source), "", pairs("Pattern", rows), *summary.notes)


def _place(angles_deg: tuple[float, float]) -> str:
    return f"theta {angles_deg[0]:g}, phi {angles_deg[1]:g} deg"
