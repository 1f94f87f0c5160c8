"""The figures of a study's report."""

from nullpose.report.study.figures.all_figures import FIGURES, figures_of

__all__ = ["FIGURES", "figures_of"]
