"""What is particular to answers of crowds: copies, repetitions, off-topic texts."""
