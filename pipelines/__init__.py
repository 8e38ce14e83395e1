"""The six stages, from raw answers to a published dataset."""
