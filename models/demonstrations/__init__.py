"""Models whose input is pictures from above of a demonstration (thesis 5.4.3, A.1)."""
