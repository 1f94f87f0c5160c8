"""Other people's engines judge the physics: a ray tracer and a wire-grid solver."""
