"""Models whose input is a description (thesis chapter 4)."""
