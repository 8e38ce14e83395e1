"""Checks of crowd-sourced answers: copies, repetitions, off-topic texts."""
