"""Rendering of worlds: meshes, cameras, rays and pictures."""
