"""Kernels compiled: decorators, the cache on disk, scratch space, and Python in their place."""
