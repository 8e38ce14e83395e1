"""Repairs, one small function a failure code, mirrored on `simulation/actions`."""
