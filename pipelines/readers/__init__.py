"""Readers: one file for each form that programs arrive in, recognised by content."""
