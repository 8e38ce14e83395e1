"""`llm judge`: the verdicts of a language model on episodes and programs, compared with the engine's."""

from pathlib import Path

from hearth.commands import output
from hearth.commands.shared_options import LanguageOptions


def judge(
    name: str,
    file: Path,
    *,
    dataset: Path | None = None,
    out: Path,
    limit: int | None = None,
    constrained: bool = False,
    models: LanguageOptions = LanguageOptions(),
    as_json: bool = False,
) -> None:
    """Let a language model judge episodes or programs, and print how far it agrees with the engine.

    FILE has episodes, of `challenge run`, or predicted programs of a dataset (--dataset). The engine's verdict is
    whether the goal was reached; the model does not see it. `informed` is the share of right cases that it accepts less
    that of wrong ones: 0 of a judge that does not look. Nothing is asked twice; cases without an answer make status 1.

    \b
    Examples:
      hearth llm judge llm:smollm2 mine.jsonl --out judged.jsonl
      hearth llm judge llm:MODEL@URL predicted.jsonl --dataset data_out --constrained --out judged.jsonl
    """
    from hearth.analysis.judge_agreement import agreement, episode_cases, program_cases
    from hearth.commands.progress_line import bar
    from hearth.kb.loading.load import default
    from hearth.llm.judge import Judge, judged
    from hearth.storage.chosen_files import write_rows

    model = models.model(name, out, constrained)
    chair = Judge(model)
    cases = list(program_cases(file, dataset, limit) if dataset else episode_cases(file, default, limit))
    with bar("cases", model.spending) as seen:
        found = judged(chair, cases, seen)
    write_rows(out, [each.as_json() for each in found])
    facts = {"out": out, **agreement(found), **chair.as_json()}
    if as_json:
        output.emit(facts)
    else:
        shown = {name: value for name, value in facts.items() if name != "faults"}
        output.figures({**shown, **{f"faults {code}": number for code, number in facts["faults"].items()}})
    output.status(sum(each.fault in UNANSWERED for each in found), strict=True)


UNANSWERED = frozenset({"NO_ANSWER", "OVER_BUDGET"})
"""The faults of cases that the same command asks again."""
