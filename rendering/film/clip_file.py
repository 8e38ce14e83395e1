"""The place of a film's arrays in a dataset of clips; readers need no other part of the renderer."""

FILE = "clips.npz"
"""Name of a film's arrays in its folder."""
