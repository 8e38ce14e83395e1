"""Models of films: which instruction is done in a clip (thesis 4.3.3, 4.5.1)."""
