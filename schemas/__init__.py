"""What things are: programs, environment graphs, goals, failure codes, table columns. Imports nothing of ours."""
