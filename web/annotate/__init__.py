"""Where people describe activities, write programs of blocks for them, and review and mark those of others."""
