"""The room where people describe activities, write programs of blocks, and review and mark others' programs."""
