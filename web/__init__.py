"""One server where people annotate, play and judge, and researchers look after a study (thesis 3.3, 6.6, B.4, C.5)."""
