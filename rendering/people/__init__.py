"""Bodies: skeleton, figure, gestures, and motion through a program."""
