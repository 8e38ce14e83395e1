"""From a graph with boxes to triangles: placement of things, and lights."""
