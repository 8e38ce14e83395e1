"""Vectors of texts: of a server that speaks the protocol of `/v1/embeddings`, or of a small model in a folder.

A server's vectors lie in the cache of its replies: no text is asked twice, and its tokens are in the same ledger.
"""

from __future__ import annotations

from base64 import b64decode, b64encode
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.llm.addresses import is_model
from hearth.llm.endpoint import Endpoint, endpoint_of
from hearth.llm.language_settings import Asking, Means
from hearth.llm.replies import Reply, tokens_of
from hearth.llm.requests_with_retries import Failed
from hearth.llm.timed_connections import asking
from hearth.models.text.mixed_similarity import Vectors
from hearth.models.text.sentence_vectors import SentenceVectors
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

PATH = "embeddings"

MOST_NUMBERS = 65_536
"""Numbers of a vector."""


def vectors_of(name: str, means: Means) -> Vectors:
    """Return what gives vectors: of `llm:MODEL@URL`, or of a folder with weights.

    Raises:
        HearthError: those of `endpoint_of` and of `SentenceVectors`.
    """
    return EndpointVectors(endpoint_of(name, Asking(), means)) if is_model(name) else _of_folder(name)


@cache
def _of_folder(name: str) -> SentenceVectors:
    return SentenceVectors(Path(name))


class EndpointVectors:
    """The vectors of a server.

    Args:
        endpoint: the model.
    """

    def __init__(self, endpoint: Endpoint) -> None:
        self._endpoint = endpoint

    def __call__(self, texts: Sequence[str]) -> NDArray[np.float32]:
        """Return a vector of length 1 for each text.

        Raises:
            HearthError: NO_ANSWER: the server gives none, or none of one length; OVER_BUDGET.
        """
        import numpy as np

        every = list(dict.fromkeys(texts))
        with ThreadPoolExecutor(self._endpoint.means.at_once) as pool, asking(pool):
            found = dict(zip(every, pool.map(self._vector, every), strict=True))
        if len({len(vector) for vector in found.values()}) > 1:
            message = f"the vectors of `{self._endpoint.model}` at {self._endpoint.where} are not of one length"
            raise HearthError.of(Code.NO_ANSWER, message, suggestion="another --cache, where the model was changed")
        return np.stack([found[text] for text in texts])

    def _vector(self, text: str) -> NDArray[np.float32]:
        import numpy as np

        model = self._endpoint
        body = {"model": model.model, "input": text, "encoding_format": "float"}
        reply = model.kept_or_asked(
            body, len(text), 0, lambda: model.tried(lambda: _read(model.send(PATH, body), len(text)))
        )
        return np.frombuffer(b64decode(reply.text), "<f4")


def _read(given: Any, asked: int) -> Reply:
    """Return a server's vector as a reply, with a length of 1.

    Raises:
        Failed: there is none, or it is no direction.
    """
    import numpy as np

    data = given.get("data") if isinstance(given, Mapping) else None
    first = data[0] if isinstance(data, list) and len(data) == 1 else None
    numbers = first.get("embedding") if isinstance(first, Mapping) else None
    if not isinstance(numbers, list) or not 0 < len(numbers) <= MOST_NUMBERS or not set(map(type, numbers)) <= NUMBERS:
        raise Failed("no vector", "JSON without a vector")
    vector = np.asarray(numbers, float)
    length = float(np.linalg.norm(vector))
    if not np.isfinite(length) or length == 0:
        raise Failed("no vector", "a vector without a direction")
    counted, tokens = tokens_of(given.get("usage"), "prompt_tokens", asked)
    return Reply(b64encode((vector / length).astype("<f4").tobytes()).decode(), tokens, 0, counted)


NUMBERS = frozenset({int, float})
