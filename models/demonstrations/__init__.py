"""Models whose input is pictures from above of what is done (thesis 5.4.3, A.1)."""
