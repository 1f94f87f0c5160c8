"""Damaged input files, thousands of them, given to the real command, which has to refuse them in words."""
