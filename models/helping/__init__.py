"""The choice of a subgoal and of actions for another person's goal: policies of Hybrid and HRL (thesis 6.5.2, B.3)."""
