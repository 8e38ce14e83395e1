"""What to do for somebody else's goal, and how: the learned policies of Hybrid and HRL (thesis 6.5.2, B.3)."""
