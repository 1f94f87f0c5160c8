"""The paper's cases, one file each: which axes are allowed, and the search under them."""
