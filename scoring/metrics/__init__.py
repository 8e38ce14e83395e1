"""The metrics: LCS, graph F1, executability, parsability, goals."""
