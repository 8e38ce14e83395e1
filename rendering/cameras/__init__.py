"""Where pictures are taken from, and what is visible from there."""
