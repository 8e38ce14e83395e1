"""The published format of datasets: codecs, ids, splits, card, croissant, catalog."""
