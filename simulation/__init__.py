"""The simulator: immutable worlds, one function an action, the engine, agents' views, homes and floor plans."""
