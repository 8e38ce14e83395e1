"""Reading the YAML and CSV of the knowledge, layer over layer, with the line of every fault."""
