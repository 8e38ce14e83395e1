"""Decoding with the engine in the loop: whatever a model scores, only steps that can be done are written."""
