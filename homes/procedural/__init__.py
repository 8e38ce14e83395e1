"""Procedural homes: random floor plans, furnished and stocked."""
