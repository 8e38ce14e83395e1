"""What happens: immutable worlds, one function an action, the engine, what an agent sees, homes and their floor plans."""
