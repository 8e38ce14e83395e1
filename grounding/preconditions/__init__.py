"""What a program needs and what it achieves: conditions inferred, abduced, assumed, checked."""
