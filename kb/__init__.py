"""The knowledge: actions, objects, places, states, synonyms, rooms and repairs. Pure look-ups over reviewable files."""
