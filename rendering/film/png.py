"""Deterministic PNG encoding."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import library

STORED = (np.uint8, np.uint16, np.float32)
"""Types of arrays that have an encoding; OpenCV silently makes 8 bits of some others."""

LEVEL = 1
"""zlib's fastest: four times as fast as the default for a few per cent more bytes."""


def encode(image: NDArray[Any]) -> bytes:
    """Return an image as PNG, without metadata.

    Args:
        image: (H, W) or (H, W, 3 in the order red, green, blue), uint8 or uint16; float32 unit vectors (normals)
            are written as 16 bits a component, (n + 1) / 2 * 65535; (H, W, 2) float32 (flow) as 16 bits
            64 * f + 32768 in red and green, with blue 1 where the flow is known (KITTI's encoding) and within 512
            pixels, which this can say.

    Raises:
        HearthError: the array's shape or type has no PNG encoding.
    """
    cv2 = library("cv2")

    if image.dtype not in STORED:
        how = "uint8, uint16 or float32; nodes and classes with numbers above 65535 need lower ones"
        raise HearthError.of(Code.NOT_RENDERED, f"no PNG of {image.shape} {image.dtype}", suggestion=how)
    if image.dtype == np.float32 and image.shape[-1] == 2:
        image = _flow_code(image)
    if image.dtype == np.float32:
        image = np.rint((np.clip(image, -1, 1) + 1) / 2 * 65535).astype(np.uint16)
    flipped = np.ascontiguousarray(image[..., ::-1]) if image.ndim == 3 else image
    done, data = cv2.imencode(".png", flipped, [cv2.IMWRITE_PNG_COMPRESSION, LEVEL])
    if not done:
        raise HearthError.of(Code.NOT_RENDERED, f"no PNG of {image.shape} {image.dtype}")
    return bytes(data)


def _flow_code(flow: NDArray[Any]) -> NDArray[np.uint16]:
    found = np.rint(flow * 64 + 32768)
    known = ((found >= 0) & (found <= 65535)).all(axis=2)
    code = np.zeros((*flow.shape[:2], 3), np.uint16)
    code[..., :2] = np.where(known[..., None], found, 0)
    code[..., 2] = known
    return code


def decode(data: bytes) -> NDArray[Any]:
    """Return the inverse of `encode`; components in the order red, green, blue.

    Raises:
        HearthError: the data are not a picture.
    """
    cv2 = library("cv2")

    image: Any = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)
    if image is None:
        raise HearthError.of(Code.NOT_RENDERED, "not a PNG picture")
    found: NDArray[Any] = image[..., ::-1] if image.ndim == 3 else image
    return found
