"""How good a program is: LCS, graph F1, parsability, executability."""
