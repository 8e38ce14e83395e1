"""The body of a request: read within a time and up to a size."""

import asyncio

from starlette.requests import ClientDisconnect, Request

from hearth.schemas.failures import Code
from hearth.web.limits import QUIET_SECONDS
from hearth.web.web_errors import WebError


async def body_of(request: Request, most: int) -> bytes:
    """Return the whole body of a request.

    Raises:
        WebError: FILE_TOO_LARGE, DISCONNECTED, TIMED_OUT.
    """
    parts, size = [], 0
    try:
        async with asyncio.timeout(QUIET_SECONDS):
            async for part in request.stream():
                size += len(part)
                if size > most:
                    raise WebError(Code.FILE_TOO_LARGE, "body", f"at most {most} bytes", "more")
                parts.append(part)
    except ClientDisconnect:
        raise WebError(Code.DISCONNECTED, "body", "the whole of it", "a part") from None
    except TimeoutError:
        raise WebError(Code.TIMED_OUT, "body", f"the whole of it within {QUIET_SECONDS:g} s", "a part") from None
    return b"".join(parts)
