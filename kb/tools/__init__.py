"""What one does with the knowledge: find, show, mine, compare, export."""
