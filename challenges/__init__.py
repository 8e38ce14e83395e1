"""What agents are asked to do, and how they did: tasks, episodes, metrics, boards, and doors for other people's agents."""
