"""Failures of perturbed environments, and their repairs."""
