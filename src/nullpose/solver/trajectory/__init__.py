"""Trajectories for scenes in motion: a search, and bounds that no trajectory exceeds."""

from nullpose.solver.trajectory.course import Aim
from nullpose.solver.trajectory.result import Trajectory
from nullpose.solver.trajectory.solve import GAP_DB, TIME_LIMIT_S, solve_trajectory

__all__ = ["GAP_DB", "TIME_LIMIT_S", "Aim", "Trajectory", "solve_trajectory"]
