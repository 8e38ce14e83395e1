"""Agents' views and reach."""
