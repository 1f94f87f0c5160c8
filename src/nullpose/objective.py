"""Objectives of the user's own: ``from nullpose.objective import Custom``."""

from __future__ import annotations

from nullpose.objectives.custom import Custom

__all__ = ["Custom"]
