"""Who acts: agents that pursue a goal, help somebody, or guess what somebody wants (thesis chapters 6 and 7)."""
