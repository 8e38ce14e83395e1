"""Readers: one file for each form of input, recognised by content."""
