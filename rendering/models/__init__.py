"""Parametric low-poly models of object classes, by size, variant and state."""
