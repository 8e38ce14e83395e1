"""Models that turn sketches into programs in a home (thesis chapter 5)."""
