"""What agents are asked to do, and how they did: tasks, episodes, metrics, boards, and ways in for others' agents."""
