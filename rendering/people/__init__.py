"""Bodies: skeleton, figure, gestures, and what they do at each moment."""
