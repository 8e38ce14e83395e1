"""Studies with people: their questions, assignment, simulation, tables, statistics and report."""
