"""Needs and results of a program: conditions inferred, abduced, assumed, checked."""
