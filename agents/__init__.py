"""Agents that pursue a goal, help a partner, or infer a partner's goal (thesis chapters 6 and 7)."""
