"""The rules over arrays, one file a subject; each follows a reading of the plain engine."""
