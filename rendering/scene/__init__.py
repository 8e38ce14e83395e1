"""From a graph with boxes to triangles: what stands where, what shines."""
