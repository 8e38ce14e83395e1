"""The thesis's figures 6-8, 7-6b and 4-9 of a study's findings."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.analysis.corpus_figures import saved
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import library
from hearth.storage.names import inside
from hearth.studies.study_findings import AGENT, PEOPLE, Findings, scales

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

STUDIES = {"6-8": "people-with-helpers", "7-6b": "online", "4-9": "programs-by-lcs", "likeness": "likeness-of-films"}
"""The study of each figure; the likeness of films has no figure in the thesis, but numbers in B.4.3."""

BLUE, ORANGE, GREY = "#1b4f72", "#d68910", "#7f8c8d"
COLOURS = {PEOPLE: BLUE, AGENT: ORANGE}
WIDTH = 0.38

SIMULATED = "simulated people: agents in people's places, not a finding about people"


def draw(number: str, found: Findings, alone: Findings | None, folder: Path) -> list[Path]:
    """Draw a figure as PNG and SVG; returns the files.

    Raises:
        HearthError: BAD_ARGUMENT: there is no such figure; MISSING_FILE: matplotlib is not installed.
    """
    if number not in FIGURES:
        raise HearthError.of(Code.BAD_ARGUMENT, f"there is no figure `{number[:20]}`", suggestion=", ".join(FIGURES))
    folder.mkdir(parents=True, exist_ok=True)
    figure = FIGURES[number](found, alone)
    if found.simulated:
        figure.suptitle(SIMULATED, fontsize=9, color="#a3262a")
    return saved(figure, inside(folder, f"figure-{number}"))


def own_figure(study: str) -> str:
    """Return the number of a study's figure; "" where it has none of its own."""
    return next((number for number, name in STUDIES.items() if name == study), "")


def names_of(found: Findings) -> dict[str, str]:
    """Return the names of the actors, in words."""
    return {PEOPLE: "simulated people" if found.simulated else "people", AGENT: "human-like agent"}


def with_helpers(found: Findings, alone: Findings | None) -> Drawing:
    """Figure 6-8: a) success and speedup, b) cumulative reward, ratings."""
    figure: Drawing = library("matplotlib.figure").Figure(figsize=(13, 4.2), layout="constrained")
    points, rewards, rated = figure.subplots(1, 3)
    groups = found.groups
    both = [(found, name, title) for name, title in groups]
    if alone is not None:
        both.insert(0, (alone, alone.groups[0][0], alone.groups[0][1]))
    for who, label in names_of(found).items():
        for source, name, title in both:
            _point(points, source, who, name, title)
        points.scatter([], [], color=COLOURS[who], label=label)
    points.set_xlabel("success rate")
    points.set_ylabel("speedup")
    points.set_title("a) success and speedup")
    points.legend(frameon=False, loc="lower left", fontsize=8)
    points.margins(0.18)
    points.locator_params(axis="x", nbins=6)
    points.set_xticks([tick for tick in points.get_xticks() if tick < 1.001])
    points.spines[["top", "right"]].set_visible(False)
    _bars(rewards, both, "reward", names_of(found))
    rewards.set_title("b) cumulative reward")
    _ratings(rated, found)
    rated.set_title("ratings, 1 to 7")
    return figure


def _point(axes: Any, found: Findings, who: str, name: str, title: str) -> None:
    success, speedup = found.figure(who, name, "success"), found.figure(who, name, "speedup")
    if success is None or speedup is None:
        return
    axes.errorbar(
        success.mean, speedup.mean, xerr=success.error or 0, yerr=speedup.error or 0, fmt="o", color=COLOURS[who],
        capsize=2,
    )  # fmt: skip
    left = who == PEOPLE
    axes.annotate(
        title.partition(" (")[0], (success.mean, speedup.mean), xytext=(-7, 4) if left else (7, -9),
        textcoords="offset points", fontsize=8, color=COLOURS[who], ha="right" if left else "left",
    )  # fmt: skip


def _bars(axes: Any, groups: list[tuple[Findings, str, str]], metric: str, names: Mapping[str, str]) -> None:
    """Draw a bar of each condition for people and one for the agent, with standard errors."""
    for offset, (who, label) in zip((-WIDTH / 2, WIDTH / 2), names.items(), strict=True):
        figures = [found.figure(who, name, metric) for found, name, _ in groups]
        there = [(place, each) for place, each in enumerate(figures) if each is not None]
        axes.bar(
            [place + offset for place, _ in there], [each.mean for _, each in there], WIDTH, color=COLOURS[who],
            label=label, yerr=[each.error or 0 for _, each in there], capsize=2,
        )  # fmt: skip
    titles = [title.replace(" (", "\n(") for _, _, title in groups]
    axes.set_xticks(range(len(groups)), titles, fontsize=8)
    axes.set_ylabel(metric)
    axes.axhline(0, color=GREY, linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, fontsize=8)


def _ratings(axes: Any, found: Findings) -> None:
    """Mean ratings of every condition, question by question."""
    groups, questions = found.groups, scales(found.study)
    width = 0.8 / max(1, len(groups))
    for turn, (name, title) in enumerate(groups):
        figures = [found.figure(PEOPLE, name, question) for question in questions]
        there = [(place, each) for place, each in enumerate(figures) if each is not None]
        axes.bar(
            [place + (turn - (len(groups) - 1) / 2) * width for place, _ in there], [each.mean for _, each in there],
            width * 0.94, yerr=[each.error or 0 for _, each in there], capsize=2, label=title.partition(" (")[0],
            color=(BLUE, "#5d8aa8", "#aabccb", GREY)[turn % 4],
        )  # fmt: skip
    axes.set_xticks(range(len(questions)), questions)
    axes.set_ylim(bottom=min(each.low for each in found.study.questions if each.kind == "scale"))
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, fontsize=8)


def online(found: Findings, alone: Findings | None) -> Drawing:
    """Figure 7-6: speedup with helpers that are not given the goal; b) is of people, a) of the agent."""
    figure: Drawing = library("matplotlib.figure").Figure(figsize=(7, 4), layout="constrained")
    axes = figure.subplots()
    helped = [(found, each.name, each.title) for each in found.study.conditions if each.helped]
    _bars(axes, helped, "speedup", names_of(found))
    axes.set_title("speedup: a) human-like agent, b) " + names_of(found)[PEOPLE])
    return figure


def by_band(found: Findings, alone: Findings | None) -> Drawing:
    """Figure 4-9: mean ratings of films of programs, by band of LCS."""
    figure: Drawing = library("matplotlib.figure").Figure(figsize=(6.4, 4), layout="constrained")
    axes = figure.subplots()
    (question, *_) = scales(found.study)
    scale = next(each for each in found.study.questions if each.name == question)
    for place, (name, _) in enumerate(found.groups):
        values = sorted(found.values.get((PEOPLE, name, question), {}).values())
        mean = found.figure(PEOPLE, name, question)
        if mean is None:
            continue
        axes.bar(place, mean.mean - scale.low, 0.6, bottom=scale.low, color="#aabccb")
        spread = [place + 0.36 * (number / max(1, len(values) - 1) - 0.5) for number in range(len(values))]
        axes.plot(spread, values, "o", color=BLUE, markersize=3)
        axes.errorbar(place, mean.mean, yerr=mean.error or 0, fmt="none", color="#22262b", capsize=4)
        axes.text(place, scale.low + 0.08, f"{mean.mean:.2f}", ha="center", fontsize=9)
    axes.set_xticks(range(len(found.groups)), [title for _, title in found.groups])
    axes.set_xlabel("normalised LCS of the program")
    axes.set_ylabel(f"mean rating of {found.study.people} judges")
    axes.set_ylim(scale.low, scale.high + 0.15)
    axes.spines[["top", "right"]].set_visible(False)
    return figure


def likeness(found: Findings, alone: Findings | None) -> Drawing:
    """Ratings of films of people and of the human-like agent (B.4.3)."""
    figure: Drawing = library("matplotlib.figure").Figure(figsize=(6.4, 4), layout="constrained")
    axes = figure.subplots()
    _ratings(axes, found)
    axes.set_ylim(top=5)
    axes.set_ylabel("mean rating, 1 to 5")
    return figure


FIGURES: dict[str, Callable[[Findings, Findings | None], Any]] = {
    "6-8": with_helpers,
    "7-6b": online,
    "4-9": by_band,
    "likeness": likeness,
}
"""The function that draws each figure."""
