"""What all stages share: the loop, workers, progress, settings."""
