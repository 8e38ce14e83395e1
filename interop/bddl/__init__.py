"""Activities of BEHAVIOR in BDDL: problems as environments and goals, and our goals as BDDL."""
