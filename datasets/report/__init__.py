"""A dataset as a folder of static HTML that needs no network and no server."""
