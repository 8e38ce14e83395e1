"""Many worlds as arrays: the same rules as the engine, compiled by numba."""
