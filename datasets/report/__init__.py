"""A report of a dataset: a folder of static HTML that works without network and server."""
