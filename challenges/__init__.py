"""Tasks for agents, and their results: tasks, episodes, metrics, boards, and ways in for others' agents."""
