"""The report of a study: one page that opens from disk, with its figure."""

from dataclasses import asdict
from pathlib import Path
from typing import Any

from hearth.schemas.optional_libraries import lacking
from hearth.storage.files import write_bytes
from hearth.storage.templates import rendered
from hearth.studies.statistical_tests import Comparison
from hearth.studies.study_figures import draw, names_of, own_figure
from hearth.studies.study_findings import METRICS, PEOPLE, Figure, Findings, scales
from hearth.version import VERSION

PAGE = "index.html"


def write_report(found: Findings, alone: Findings | None, folder: Path) -> list[Path]:
    """Write the page, and the study's figure if matplotlib is installed; returns the files."""
    folder.mkdir(parents=True, exist_ok=True)
    number = own_figure(found.study.name)
    pictures = draw(number, found, alone, folder) if number and "matplotlib" not in lacking("pictures") else []
    names = [each.name for each in pictures if each.suffix == ".svg"]
    write_bytes(folder / PAGE, page(found, names).encode())
    return [folder / PAGE, *pictures]


def page(found: Findings, pictures: list[str]) -> str:
    """Return the page as HTML; every text is escaped."""
    questions = [(each.name, each.text) for each in found.study.questions if each.kind == "scale"]
    return rendered(
        "hearth.studies",
        "study_report.html",
        study=found.study,
        found=found,
        people=names_of(found)[PEOPLE],
        pictures=pictures,
        failures=failures(found),
        measured=_measured(found),
        rated=_rated(found),
        questions=questions,
        correlations=[(name, f"{rho:.2f}", probability(p)) for name, (rho, p) in found.correlations.items()],
        tests=[test_row(each) for each in found.comparisons],
        bonferroni=f"{0.05 / max(1, len(found.comparisons)):.4f}",
        version=VERSION,
    )


def failures(found: Findings) -> list[str]:
    """Return the notes about helpers that could not go on, a line for each condition."""
    titles = dict(found.groups)
    return [
        f"{titles[name]}: the helper failed in {count} {'trial' if count == 1 else 'trials'}. "
        "That is no failure of the person: these trials are left out of success, speedup, reward and ticks."
        for name, count in sorted(found.helper_faults.items())
    ]


def _measured(found: Findings) -> list[dict[str, Any]]:
    if found.study.films is not None:
        return []
    rows = []
    titles = dict(found.groups)
    for group in titles if "alone" in titles else ("alone", *titles):
        for who, label in names_of(found).items():
            figures = [found.figure(who, group, metric) for metric in METRICS]
            if figures[0] is not None:
                cells = [
                    _cell(each, 1 if metric == "length" else 2) for each, metric in zip(figures, METRICS, strict=True)
                ]
                rows.append(
                    {"title": titles.get(group, "Alone"), "who": label, "count": figures[0].count, "cells": cells}
                )
    return rows


def _rated(found: Findings) -> list[dict[str, Any]]:
    rows = []
    for name, title in found.groups:
        figures = [found.figure(PEOPLE, name, question) for question in scales(found.study)]
        if any(figures):
            rows.append({"title": title, "cells": [_cell(each, 2) for each in figures]})
    return rows


def _cell(figure: Figure | None, places: int) -> str:
    if figure is None:
        return ""
    error = "" if figure.error is None else f" ± {figure.error:.{places}f}"
    return f"{figure.mean:.{places}f}{error}"


def test_row(each: Comparison) -> list[str]:
    """Return a test as the page and the command show it."""
    shown = [each.metric, each.one, each.other, str(each.pairs)]
    if each.difference is None:
        return [*shown, "", "", "", "", "", "", each.thesis]
    if each.t is None:
        return [*shown, f"{each.difference:.2f}", "", "", "", "", "", each.thesis]
    normal = "" if each.normality is None else f"{each.normality:.2f}, {probability(each.normality_p)}"
    return [
        *shown,
        f"{each.difference:.2f} [{each.low:.2f}, {each.high:.2f}]",
        f"t({each.freedom}) = {each.t:.2f}",
        probability(each.p),
        f"{each.effect:.2f} [{each.effect_low:.2f}, {each.effect_high:.2f}]",
        normal,
        probability(each.signed_p),
        each.thesis,
    ]


def probability(p: float | None) -> str:
    """Return a probability as papers print it."""
    if p is None:
        return ""
    return "< .001" if p < 0.001 else f"{p:.3f}".lstrip("0")


def as_json(found: Findings) -> dict[str, Any]:
    """Return the findings for machines."""
    figures = {
        f"{who}/{group}/{metric}": asdict(figure)
        for who, group, metric in found.values
        if (figure := found.figure(who, group, metric)) is not None
    }
    return {
        "study": found.study.name,
        "simulated": found.simulated,
        "finished": found.people,
        "left": found.left,
        "against": found.against,
        "helper_faults": found.helper_faults,
        "figures": figures,
        "tests": [asdict(each) for each in found.comparisons],
        "correlations": {name: {"rho": rho, "p": p} for name, (rho, p) in found.correlations.items()},
    }
