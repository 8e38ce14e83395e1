"""Export of datasets: the release's layout, natural language, JSON Lines, Python, graphs, PDDL, triples."""
