"""Tasks for agents, and their results: tasks, goals, episodes, metrics, results; wire protocol."""
