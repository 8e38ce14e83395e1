"""The common parts of all stages: the loop, workers, progress, settings."""
