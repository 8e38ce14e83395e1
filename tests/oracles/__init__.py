"""Slow, plain twins of what is fast here: each says what its fast counterpart must say."""
