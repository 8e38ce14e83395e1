"""The fault that a request is answered with, for every error that a handler may raise."""

import errno

from sqlalchemy.exc import OperationalError
from starlette.exceptions import HTTPException
from starlette.responses import Response

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.web.room_request import json_answer
from hearth.web.web_errors import WebError

NO_MORE = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
"""Numbers of the errors of a full disk."""


def fault_of(error: Exception) -> WebError:
    """Return an error as a fault; what is ours is said without a value."""
    if isinstance(error, WebError):
        return error
    if isinstance(error, HTTPException):
        code = Code.UNKNOWN_ID if error.status_code == 404 else Code.BAD_ARGUMENT
        return WebError(code, "address", "an address of this server, and a method it has", error.detail)
    if isinstance(error, HearthError):
        fault = error.diagnostics[0]
        return WebError(fault.code, fault.place(), fault.suggestion, fault.message)
    if isinstance(error, OSError) and error.errno in NO_MORE:
        return WebError(Code.UNWRITABLE, "server", "room on its disk", "a full disk")
    if isinstance(error, OSError) and error.errno in (errno.EMFILE, errno.ENFILE):
        return WebError(Code.TIMED_OUT, "server", "fewer requests at once", "as many open files as it may have")
    if isinstance(error, OperationalError):
        return WebError(Code.MISSING_FILE, "store", "a store that can be used", "one that can't be, see the log")
    return WebError(Code.INTERNAL_ERROR, "server", "an answer", "an error in Hearth, not in your request")


def refusal(error: Exception) -> Response:
    """Return the answer to a program's request that is refused: JSON, with the status of its fault."""
    fault = fault_of(error)
    answer = json_answer(fault.as_json(), error.status_code if isinstance(error, HTTPException) else fault.status)
    if fault.code is Code.TIMED_OUT:  # what is left of a body is not waited for
        answer.headers["Retry-After"], answer.headers["Connection"] = "2", "close"
    return answer
