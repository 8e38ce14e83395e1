"""The embedded corpus and homes, as package data. Never edited by code."""
