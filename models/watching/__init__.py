"""A person's goal, inferred from observations of their actions (thesis 6.4, B.3.1)."""
