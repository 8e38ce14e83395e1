"""Published datasets: reading, tensors, verification, differences, export, report."""
