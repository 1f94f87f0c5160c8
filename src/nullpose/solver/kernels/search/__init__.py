"""Better poses from given ones, by compiled local searches."""
