"""What breaks when conditions are perturbed, and how it is mended."""
