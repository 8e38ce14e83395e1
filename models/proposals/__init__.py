"""Goals proposed from how the state has changed: the goal proposal network (thesis 7.3.3, C.3.2)."""
