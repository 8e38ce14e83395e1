"""The rate of films where no other is asked for; commands read it without the renderer."""

FILM_RATE = 15.0
"""Pictures a second."""
