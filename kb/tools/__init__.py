"""Tools for the knowledge: find, show, mine, compare, export."""
