"""Grounding: preconditions of a program, binding its objects to a home, sampling an environment."""
