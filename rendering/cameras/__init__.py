"""Cameras, the choice among them, and the visibility of objects."""
