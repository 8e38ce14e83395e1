"""What it looks like: meshes, cameras, rays and pictures."""
