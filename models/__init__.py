"""Models that write programs from descriptions, sketches and films (thesis 4, 5); needs the extra `models`."""
