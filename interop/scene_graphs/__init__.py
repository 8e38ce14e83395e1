"""Scene graphs of other projects: their things, rooms, places and relations, read as a home of ours."""
