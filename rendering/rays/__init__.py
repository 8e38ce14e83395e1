"""Casting rays and shading what they hit."""
