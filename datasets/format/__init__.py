"""The form in which datasets are published: codecs, ids, splits, card, croissant, catalog."""
