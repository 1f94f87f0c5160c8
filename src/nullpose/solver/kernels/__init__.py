"""Compiled kernels. They see numbers only: no names, no units, no scenario.

Families, domains and axis fields travel as the named tuples of :mod:`nullpose.problem.records`.
"""
