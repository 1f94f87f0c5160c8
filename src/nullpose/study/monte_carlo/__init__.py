"""Studies: many random scenes, each solved in several cases over swept values."""

from nullpose.study.monte_carlo.draw import draw_scene, scene_at
from nullpose.study.monte_carlo.loading import load_spec
from nullpose.study.monte_carlo.reading import (
    StudyStatus,
    StudyTable,
    read_study,
    study_spec,
    study_status,
)
from nullpose.study.monte_carlo.run import StudyProgress, run_study
from nullpose.study.monte_carlo.spec import StudySpec

__all__ = [
    "StudyProgress",
    "StudySpec",
    "StudyStatus",
    "StudyTable",
    "draw_scene",
    "load_spec",
    "read_study",
    "run_study",
    "scene_at",
    "study_spec",
    "study_status",
]
