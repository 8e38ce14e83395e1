"""Pictures and films of executions, and the page that plays them."""
