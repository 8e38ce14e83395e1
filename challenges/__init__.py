"""What agents are asked to do, and how they did: tasks, goals, episodes, metrics, results; wire protocol."""
