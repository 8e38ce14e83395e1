"""Environments for learners and language models: observations, action codes, rewards; Gymnasium and PettingZoo."""
