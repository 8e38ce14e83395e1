"""Moving by metres, and where to stand and with which hand to act."""
