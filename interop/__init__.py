"""Formats and protocols of other projects, written and read on top of ours."""
