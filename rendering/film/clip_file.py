"""Where a film of a dataset of clips has its arrays; readers need no more of the renderer."""

FILE = "clips.npz"
"""Name of a film's arrays in its folder."""
