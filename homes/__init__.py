"""Homes: floor plans, their geometry, and the scene graphs that follow from it."""
