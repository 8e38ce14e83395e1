"""Environments for learners and language models: observations, action codes, rewards, and the interfaces of libraries."""
