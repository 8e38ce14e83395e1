"""What happens: immutable worlds, one function an action, the engine, what an agent sees, homes and floor plans."""
