"""Compiled kernels. They see numbers only: no names, no units, no scenario.

A family travels as one tuple of arrays, in the order of :class:`nullpose.family.FamilyArrays`.
"""
