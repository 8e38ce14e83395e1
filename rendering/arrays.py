"""Types of the arrays of pictures, meshes and rays."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.floating[Any]]
Ints = NDArray[np.int32]
Bytes = NDArray[np.uint8]
Image = NDArray[Any]
"""Pixels of a modality, in rows from the top."""
