"""Pictures of what was found. Matplotlib is imported only when one is drawn."""

from nullpose.report.figures.airframes import draw_airframes
from nullpose.report.figures.poses import draw_array, draw_pose, draw_poses, draw_robust
from nullpose.report.figures.sweep import draw_sweep

__all__ = [
    "draw_airframes",
    "draw_array",
    "draw_pose",
    "draw_poses",
    "draw_robust",
    "draw_sweep",
]
