"""Stage two: read a description, set the scene, put the program together, check it, run it, submit it (figure 3-3)."""

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from typing import Any

from starlette.responses import Response

from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Code
from hearth.schemas.spoken_words import spoken
from hearth.web.annotate import annotated_programs, block_grammar, live_check, trial_run
from hearth.web.annotate.annotate_tables import SUBMITTED
from hearth.web.annotate.program_draft import MOST_KINDS, Draft, read_blocks, read_quantity, stored
from hearth.web.messages import int_field, text_field
from hearth.web.phrases import say
from hearth.web.room_request import Visit
from hearth.web.store import Row
from hearth.web.web_errors import WebError

Run = Callable[[Draft, str, str, Knowledge], dict[str, Any]]


def task_list(visit: Visit) -> Response:
    """Return step one: the descriptions that the person may write a program for."""
    tasks, thanks = annotated_programs.tasks(visit.web.store, visit.person), visit.fields.get("thanks") == "yes"
    following = next((each for each in tasks if not each["state"]), None)
    return visit.page("annotate/tasks.html", tasks=tasks, thanks=thanks, following=following)


def words_of(visit: Visit, text: Row, draft: Draft) -> list[tuple[str, list[dict[str, Any]]]]:
    """Return the steps of a program in words, each with its faults and notes."""
    found = check_of(visit, text, draft)
    steps = [[each for each in found if each["step"] == number] for number in range(len(draft.blocks))]
    return [(block.words(visit.web.known, draft), some) for block, some in zip(draft.blocks, steps, strict=True)]


def read_task(visit: Visit) -> Response:
    """Step two: the description."""
    text = _text(visit)
    program = annotated_programs.own_program(visit.web.store, visit.person, text["id"])
    return visit.page("annotate/read.html", text=text, program=program, mine=text["session"] == visit.person)


def scene_page(visit: Visit) -> Response:
    """Step three: rooms and props."""
    empty = visit.fields.get("empty") == "yes"
    return _scene_page(visit, _draft(visit), 200, say("annotate", "empty_scene") if empty else "")


def set_scene(visit: Visit) -> Response:
    """Store the scene; go on to the blocks, or stay to add another prop."""
    draft, text = _draft(visit), visit.part("text")
    if _own(visit)["state"] not in annotated_programs.CHANGED:
        return visit.go(f"/annotate/task/{text}/compose?closed=scene")
    rooms = {
        name: count for name in visit.web.known.rooms if (count := read_quantity(visit.field(f"room {name}"), name))
    }
    props = {name: count for name in draft.props if (count := read_quantity(visit.field(f"prop {name}", 10), name))}
    wanted, going = visit.field("add", 100).strip(), visit.field("go", 10) == "compose"
    fault = _added(visit, wanted, props) if wanted else ""
    version = int(visit.field("version", 9)) if visit.field("version", 9).isdecimal() else 0
    draft = draft.with_scene(rooms, props)
    annotated_programs.save(visit.web.store, visit.person, text, version, draft)
    if going and not fault and not draft.things():
        fault = say("annotate", "empty_scene")
    if fault:
        return _scene_page(visit, draft, 400, fault, wanted)
    return visit.go(f"/annotate/task/{text}/compose" if going else f"/annotate/task/{text}/scene#add")


def _added(visit: Visit, wanted: str, props: dict[str, int]) -> str:
    """Add a thing to the props, by any of its names; return the fault where there is none, with the nearest names."""
    known = visit.web.known
    found = known.object_class(wanted) or known.object_class(_by_words(known).get(wanted.casefold(), ""))
    if found is None or found.category in ("Rooms", "Characters"):
        near = ", ".join(dict.fromkeys(f"“{spoken(name)}”" for name in known.suggest(wanted)))
        advice = say("annotate", "near", names=near) if near else say("annotate", "none_near")
        return f"{say('annotate', 'unknown_thing', thing=wanted)} {advice}"
    if len(props) >= MOST_KINDS and found.name not in props:
        return say("annotate", "too_many", most=MOST_KINDS)
    props[found.name] = max(1, read_quantity(visit.field("quantity", 10), "quantity"))
    return ""


@lru_cache(maxsize=4)
def _by_words(known: Knowledge) -> dict[str, str]:
    """Return the classes of things by the words that people read for them."""
    things = ((name, thing) for name, thing in known.objects.items() if thing.category not in ("Rooms", "Characters"))
    return {spoken(name): name for name, _ in sorted(things, reverse=True)}


def _scene_page(visit: Visit, draft: Draft, status: int, fault: str, wanted: str = "") -> Response:
    program, text = _own(visit), _text(visit)
    if not draft.rooms and not draft.props and text["scene"].replace(" ", "_") in visit.web.known.rooms:
        draft = draft.with_scene({text["scene"].replace(" ", "_"): 1}, {})  # where the activity begins
    values: dict[str, Any] = {"rooms": visit.web.known.rooms, "names": sorted(_by_words(visit.web.known)),
                              "draft": draft, "version": program["version"], "fault": fault, "wanted": wanted,
                              "closed": program["state"] not in annotated_programs.CHANGED}  # fmt: skip
    return visit.page("annotate/scene.html", status, text=text, **values)


def compose(visit: Visit) -> Response:
    """Step four: the program."""
    text, program = _text(visit), _own(visit)
    draft = stored(program["draft"])
    if not draft.things():
        return visit.go(f"/annotate/task/{text['id']}/scene?empty=yes")
    base, closed = f"/annotate/task/{text['id']}", program["state"] not in annotated_programs.CHANGED
    values: dict[str, Any] = {
        "base": base,
        "mode": "write",
        "homes": trial_run.homes(),
        "closed": closed,
        "program": program,
        "words": words_of(visit, text, draft) if closed else [],
        "taken_back": visit.fields.get("back") == "yes",
        "scene_closed": closed and visit.fields.get("closed") == "scene",
    }
    return visit.page("annotate/compose.html", text=text, **values)


def work(visit: Visit) -> Response:
    """Return the program, the blocks and the things, for the page's scripts."""
    program = _own(visit)
    return visit.answer(work_of(visit, program, stored(program["draft"])))


def work_of(visit: Visit, program: Row, draft: Draft) -> dict[str, Any]:
    """Return the work of any program, as JSON."""
    known = visit.web.known
    blocks = {"actions": block_grammar.actions(known), "things": block_grammar.things(draft, known)}
    changes = program["state"] in annotated_programs.CHANGED
    return {"version": program["version"], "steps": draft.as_json()["steps"], "changes": changes, **blocks}


def save(visit: Visit) -> Response:
    """Keep the steps as they are; they may have empty slots."""
    message = visit.json()
    draft = sent(visit, message, _draft(visit))
    version, program = int_field(message, "version", 1, 10**9), _own(visit)
    same = draft.dumped() == program["draft"] and program["state"] in annotated_programs.CHANGED
    if same:  # as a page does that is opened; it takes nothing from another tab
        version = int(program["version"])
    else:
        version = annotated_programs.save(visit.web.store, visit.person, visit.part("text"), version, draft)
    return visit.answer({"version": version, "found": check_of(visit, _text(visit), draft)})


def submit(visit: Visit) -> Response:
    """Hand the program in for review, if it has no fault; one that does not run is asked about once.

    Pages send the home in which its author tries it, and `sure` once the author has read why it does not run.
    """
    message = visit.json()
    draft, text = sent(visit, message, _draft(visit)), _text(visit)
    if refused := refusal(check_of(visit, text, draft)):
        return visit.answer(refused, 400)
    if "home" in message and message.get("sure") is not True:
        visit.web.rates["run"].check(f"{visit.person} hands in", "submit")
        result = trial_run.run_draft(draft, text["title"], text_field(message, "home", 40), visit.web.known)
        if not result["ran"]:
            return visit.answer({"ask": say("annotate", "does_not_run", home=result["home"], why=result["why"])})
    version = int_field(message, "version", 1, 10**9)
    annotated_programs.save(visit.web.store, visit.person, visit.part("text"), version, draft, SUBMITTED)
    return visit.answer({"go": "/annotate/tasks?thanks=yes"})


def refusal(found: list[dict[str, Any]]) -> dict[str, Any] | None:
    """Return the answer to a program with faults, with the first in words; None if it has none."""
    faults = [each for each in found if each["fault"]]
    if not faults:
        return None
    first = faults[0]
    place = f"step {first['step'] + 1}" if first["step"] >= 0 else "program"
    said = {"fault": first["message"], "remedy": first["remedy"]}
    words = str(say("annotate", "in_step", number=first["step"] + 1, **said) if first["step"] >= 0
                else say("annotate", "in_program", **said))  # fmt: skip
    if len(faults) > 1:
        words = say("annotate", "further", first=words, count=len(faults) - 1)
    fault = WebError(Code[first["code"]], place, "a program without faults", first["message"])
    return {**fault.as_json(), "found": found, "words": words}


def try_out(visit: Visit) -> Response:
    """Run the program in a home."""
    message = visit.json()
    return ran(visit, _text(visit), message, sent(visit, message, _draft(visit)))


def replay(visit: Visit) -> Response:
    """Return the same run in 3D."""
    message = visit.json()
    return ran(visit, _text(visit), message, sent(visit, message, _draft(visit)), trial_run.replay_draft)


def ran(visit: Visit, text: Row, message: dict[str, Any], draft: Draft, run: Run = trial_run.run_draft) -> Response:
    """Answer with a run of a draft, in words or in 3D; or with its faults."""
    if refused := refusal(check_of(visit, text, draft)):
        return visit.answer(refused, 400)
    return visit.answer(run_of(visit, text, message, draft, run))


def run_of(
    visit: Visit, text: Row, message: dict[str, Any], draft: Draft, run: Run = trial_run.run_draft
) -> dict[str, Any]:
    """Return a run, in the home that a message names, of a draft without faults: in words, or in 3D.

    Raises:
        WebError: TOO_FAST.
    """
    visit.web.rates["run"].check(visit.person, "run")
    return run(draft, text["title"], text_field(message, "home", 40), visit.web.known)


def plan(visit: Visit) -> Response:
    """Return the floor plan of a home."""
    trial_run.home_of(visit.part("home"), visit.web.known)
    return Response(trial_run.plan_of(visit.part("home"), visit.web.known), media_type="image/svg+xml")


def shapes(visit: Visit) -> Response:
    """Return the shapes of a home in 3D."""
    found = trial_run.shapes_of(visit.part("home"), visit.web.known)
    return Response(found, media_type="application/json", headers={"Cache-Control": "private, max-age=3600"})


def replay_script(visit: Visit) -> Response:
    """Return the script that plays runs in 3D."""
    return Response(trial_run.replay_script(), media_type="text/javascript")


def check_of(visit: Visit, text: Row, draft: Draft) -> list[dict[str, Any]]:
    """Return the faults and warnings of a draft for a description."""
    found = live_check.check_draft(draft, text["title"], text["description"], visit.web.known)
    return [each._asdict() for each in found]


def _text(visit: Visit) -> Row:
    return annotated_programs.text_of(visit.web.store, visit.part("text"))


def _own(visit: Visit) -> Row:
    return annotated_programs.seen(visit.web.store, visit.person, _text(visit)["id"])


def _draft(visit: Visit) -> Draft:
    return stored(_own(visit)["draft"])


def sent(visit: Visit, message: dict[str, Any], scene: Draft) -> Draft:
    """Return the draft with the steps that a page sent."""
    return replace(scene, blocks=read_blocks(message.get("steps"), scene, visit.web.known))
