"""Addresses of language models, `llm:MODEL@URL`, and the keys of their servers, which only the environment has."""

from __future__ import annotations

import os
import re
from ipaddress import ip_address
from urllib.parse import SplitResult, parse_qsl, urlsplit

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

SCHEME = "llm:"
"""The beginning of the name of a language model among agents and models."""

URL = "HEARTH_LLM_URL"
"""The variable with the address that a name without one means."""

LOCAL = "http://127.0.0.1:8080/v1"
"""The address of `hearth llm serve`, where nothing else is said."""

KEY = "HEARTH_LLM_KEY"
"""The variable with the key for the server whose address is given."""

KEYS_OF_HOSTS = {"api.openai.com": "OPENAI_API_KEY", "openrouter.ai": "OPENROUTER_API_KEY"}
"""Variables whose key is sent to one host alone."""

HARMLESS = frozenset({"api-version"})
"""The fields of a query that an address may have; others may be keys."""

LONGEST_KEY = 4_096
"""Characters of a key; servers refuse longer headers."""

HIDDEN = "[key]"
"""Stands where a key was."""

_NAMED = re.compile(r"llm:(?P<model>[^@\s][^\s]*?)(?:@(?P<url>https?://.*))?", re.DOTALL)
_HOST = re.compile(r"@(?:localhost|[^@]*[/:.][^@]*)$")
"""An address without `http://` behind a model's name: it would be taken for a part of the name."""

_REMEDY = f"put the key into the environment variable {KEY}, and leave it out of the address"


def is_model(name: str) -> bool:
    """Return whether an agent's or a model's name begins as that of a language model."""
    return name.startswith(SCHEME)


def read_name(name: str) -> tuple[str, str]:
    """Return the model and the address of `llm:MODEL@URL`, or of `llm:MODEL`, whose address the environment has.

    Raises:
        HearthError: BAD_ARGUMENT: it is not such a name; as of `checked_url`. The message repeats no address.
    """
    found = _NAMED.fullmatch(name)
    if found is None or "://" in found["model"] or _HOST.search(found["model"]):
        message = "a language model's name is not `llm:MODEL@URL`"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=f"llm:smollm2@{LOCAL}")
    return found["model"], checked_url(found["url"] or os.environ.get(URL, LOCAL))


def checked_url(url: str) -> str:
    """Return an address without a slash at its end.

    Raises:
        HearthError: BAD_ARGUMENT: it is not of http or https, or holds a user, a password or a query. The message names
            the host alone, because the rest may be a key.
    """
    try:
        parts = urlsplit(url)
        host, _ = parts.hostname, parts.port
    except ValueError:
        parts, host = SplitResult("", "", "", "", ""), None
    if parts.scheme not in ("http", "https") or not host or not url.isprintable() or " " in url:
        message = "a server's address is not `http://HOST/v1` or `https://HOST/v1`"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=LOCAL)
    fields = {name for name, _ in parse_qsl(parts.query, keep_blank_values=True)}
    if "@" in parts.netloc:
        raise HearthError.of(Code.BAD_ARGUMENT, f"the address at {host} holds a user or a key", suggestion=_REMEDY)
    if fields - HARMLESS or (parts.query and not fields) or parts.fragment:
        raise HearthError.of(Code.BAD_ARGUMENT, f"the address at {host} holds a query", suggestion=_REMEDY)
    return url.rstrip("/")


def is_here(url: str) -> bool:
    """Return whether an address is one of this machine: what is sent there passes no proxy."""
    host = urlsplit(url).hostname or ""
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return host == "localhost" or host.endswith(".localhost")


def key_for(url: str, variable: str = "") -> str:
    """Return the key for a server, of the environment; "" where there is none.

    Args:
        url: the server's address.
        variable: with the key; else `HEARTH_LLM_KEY`, or the variable that belongs to the host.

    Raises:
        HearthError: BAD_ARGUMENT: the variable is not set, or its value cannot be a key. The message repeats neither,
            because both may be keys.
    """
    if variable:
        if variable not in os.environ:
            message = "the variable that `key` names is not set"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=f"export {KEY}=..., and leave `key` out")
        return _sendable(os.environ[variable])
    of_host = KEYS_OF_HOSTS.get(urlsplit(url).hostname or "")
    return _sendable(os.environ.get(KEY) or (os.environ.get(of_host, "") if of_host else ""))


def _sendable(text: str) -> str:
    """Return a key as a header can have it; libraries repeat in their errors what they refuse to send."""
    key = text.strip()
    if not key.isascii() or not key.isprintable() or len(key) > LONGEST_KEY:
        message = f"the key for the server is not one line of up to {LONGEST_KEY:,} printable ASCII characters"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=f"set {KEY} again, to the key alone")
    return key


def without_key(text: str, key: str) -> str:
    """Return a text in which nothing of a key is left: servers repeat what they are sent."""
    return text.replace(key, HIDDEN) if len(key) > 3 else text
