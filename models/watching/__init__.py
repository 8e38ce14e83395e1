"""What somebody wants, inferred from what was seen of what they did (thesis 6.4, B.3.1)."""
