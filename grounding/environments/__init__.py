"""Sampling environments in which given conditions hold, or are violated."""
