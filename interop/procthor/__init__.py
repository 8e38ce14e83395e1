"""Houses of ProcTHOR: read as homes of ours, and our homes written as houses."""
