"""The door for programs that play in text: worlds over HTTP, in the shape that AgentGym's clients expect."""
