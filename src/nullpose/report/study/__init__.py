"""The report of a study: its statistics, figures and tables, and its answer in words."""

from nullpose.report.study.writing import StudyReport, report_study

__all__ = ["StudyReport", "report_study"]
