"""Data types: programs, environment graphs, goals, failure codes, table columns. Imports nothing of ours."""
