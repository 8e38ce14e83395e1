"""A world as a value: the home, what differs from it, and how two worlds differ."""
