"""Reading what a person says: clauses, things, acts, and the program that does them."""
