"""Floor plans as people write them, read, checked and laid out in metres."""
