"""The Embodied Agent Interface: its wheels, its four abilities, its scores by its rules and by ours."""
