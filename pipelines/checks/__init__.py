"""Checks of programs, and safe corrections."""
