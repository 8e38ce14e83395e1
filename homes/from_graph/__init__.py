"""A layout for a scene graph that has none."""
