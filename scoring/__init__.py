"""Evaluation of predicted programs: LCS, graph F1, parsability, executability, goals."""
