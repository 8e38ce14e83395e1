"""Bytes on disk: atomic files, digests, partitions, manifests, locks, archives, stores. Knows nothing of programs."""
