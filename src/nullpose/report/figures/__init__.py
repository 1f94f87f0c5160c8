"""Pictures of what was found. Matplotlib is imported with the modules that draw, not with ``style``."""
