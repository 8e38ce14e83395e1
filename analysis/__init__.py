"""Studies of a corpus and of a dataset: statistics, figures, ratings, synthesis, coverage, agreement."""
