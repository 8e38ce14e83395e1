"""Studies of corpora and datasets: statistics, figures, ratings, synthesis, coverage, agreement of preconditions."""
