"""A published dataset in other forms: the release's layout, words, JSON Lines, Python, graphs, triples."""
