"""Studies with people: what they are asked, who does what, their simulation, tables, statistics and report."""
