"""What arrays of pictures, meshes and rays hold."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.floating[Any]]
Ints = NDArray[np.int32]
Bytes = NDArray[np.uint8]
Image = NDArray[Any]
"""Pixels in rows from the top, of whatever a modality holds."""
