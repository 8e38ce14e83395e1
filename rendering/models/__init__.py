"""Parametric low-poly models: what a class of object looks like, by size, variant and state."""
