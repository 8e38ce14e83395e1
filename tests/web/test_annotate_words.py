"""Words for annotators about their work: words of the blocks, questions at hand-in, the list of handed-in work."""

from __future__ import annotations

import re

import pytest
from web.test_annotate import PROPS, ROOMS, STEPS, TEXT, described, scene, submitted

from hearth.web.annotate.descriptions import folded
from hearth.web.phrases import NOT_FOR_PEOPLE

EMPTY = {"action": "Grab", "things": [None]}


@pytest.fixture
def set_up(person):
    text = described(person)
    scene(person, text, ROOMS, PROPS)
    return text


def post(client, text, path, steps, **more):
    version = client.get(f"/annotate/task/{text}/work").json()["version"]
    sent = {"version": version, "home": "birch", "steps": steps, **more}
    return client.post(f"/annotate/task/{text}/{path}", json=sent)


@pytest.mark.parametrize("path", ["run", "replay", "submit"])
def test_an_empty_slot_is_said_in_the_words_of_its_block(person, set_up, path):
    answer = post(person, set_up, path, [EMPTY])
    assert answer.status_code == 400
    assert answer.json()["words"] == "Step 1: “Grab …” has an empty slot: put a thing of your scene into it."


def test_an_empty_program_is_said_once_and_as_such(person, set_up):
    found = post(person, set_up, "save", []).json()["found"]
    assert [each["message"] for each in found] == ["The program has no steps yet"]
    assert post(person, set_up, "submit", []).json()["words"] == "The program has no steps yet: add the first one."


def test_advice_names_blocks_and_things_as_people_do(person, set_up):
    steps = [{"action": "Grab", "things": [["remote_control", 1]]}, {"action": "Dance", "things": []}]
    found = post(person, set_up, "save", steps).json()["found"]
    said = [f"{each['message']}: {each['remedy']}" for each in found]
    assert any("put “Walk to remote control” before this step" in each for each in said), said
    assert any("“Dance” can be written" in each for each in said)
    assert any(each.startswith("In your scene, but not used:") for each in said)
    for each in said:
        assert not NOT_FOR_PEOPLE.search(each) and not re.search(r"[\[<(]\w|props", each), each


def test_why_a_run_stops_is_said_without_notation(person, set_up):
    place = {"action": "PutBack", "things": [["remote_control", 1], ["sofa", 1]]}
    result = post(person, set_up, "run", [place, place]).json()
    assert result["ran"] is False
    assert "take it first" in result["why"], result["why"]
    assert not re.search(r"\[\w|_", result["why"]), result["why"]


def test_what_does_not_run_is_asked_about_once(person, set_up):
    steps = [{"action": "Walk", "things": [["sofa", 1]]}, {"action": "Dance", "things": []}]
    asked = post(person, set_up, "submit", steps)
    assert asked.status_code == 200 and "It does not run in birch yet" in asked.json()["ask"]
    assert person.get(f"/annotate/task/{set_up}/work").json()["changes"]
    assert "go" in post(person, set_up, "submit", steps, sure=True).json()


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"title": "asdf qwrt", "description": "xkcd jjj kkk lll mmm nnn xkcd jjj kkk lll ppp"}, "like words"),
        ({"description": "Ich gehe ins Bad, nehme meine Zahnbürste und putze mir lange die Zähne."}, "like English"),
        ({}, "the same description before"),
    ],
)
def test_odd_descriptions_are_questioned_with_a_way_on(person, changed, said):
    described(person)
    answer = person.post("/annotate/describe", data={**TEXT, **changed, "ask": "yes"})
    assert answer.status_code == 400 and said in answer.text and "Hand it in as it is</button>" in answer.text
    assert person.post("/annotate/describe", data={**TEXT, **changed}).status_code == 303


def test_a_description_of_some_care_is_not_questioned(person):
    assert person.post("/annotate/describe", data={**TEXT, "ask": "yes"}).status_code == 303
    assert folded(" Walk \n TO ") == "walk to"


def test_a_text_that_is_too_long_is_answered_and_kept(person):
    long = "Walk to the sofa and sit. " * 400
    answer = person.post("/annotate/describe", data={"title": "Sit down", "description": long})
    assert answer.status_code == 400 and "shorten it to 2,000 characters" in answer.text and long.strip() in answer.text


def test_one_word_is_one_word(person):
    assert "1 word so far" in person.post("/annotate/describe", data={"title": "Sit", "description": "Sit."}).text


def test_an_empty_scene_is_said_and_unknown_things_have_advice(person):
    text = described(person)
    answer = person.post(f"/annotate/task/{text}/scene", data={"go": "compose", "version": "1"})
    assert answer.status_code == 400 and "at least one room or thing" in answer.text
    assert "/scene?empty=yes" in person.get(f"/annotate/task/{text}/compose").headers["location"]
    page = person.post(f"/annotate/task/{text}/scene", data={"add": "xyzzyq", "version": "2"}).text
    assert "Nothing is called “xyzzyq”." in page and 'value="xyzzyq"' in page


def test_things_are_found_by_the_words_that_people_read(person):
    text = described(person)
    add = {"add": "table lamp", "quantity": "1", "version": "1"}
    assert person.post(f"/annotate/task/{text}/scene", data=add).status_code == 303
    page = person.get(f"/annotate/task/{text}/scene").text
    assert ">table lamp</label>" in page and '<option value="toothpaste">' in page and "tooth_paste" not in page


def test_what_was_handed_in_is_seen_and_taken_back(person, set_up):
    submitted(person, set_up, STEPS)
    page = person.get(f"/annotate/task/{set_up}/compose").text
    assert "Watch television" in page and "Take it back" in page
    answer = person.post(f"/annotate/task/{set_up}/scene", data={"add": "cup", "version": "9"})
    assert answer.headers["location"].endswith("/compose?closed=scene"), "not “open in another tab”"
    back = person.post(f"/annotate/mine/back/{set_up}").headers["location"]
    assert "It is not handed in now" in person.get(back).text
    assert person.get(f"/annotate/task/{set_up}/work").json()["changes"]


def test_a_piece_of_work_is_withdrawn_by_its_author_alone(server, person, set_up):
    submitted(person, set_up, STEPS)
    assert 'href="/annotate/mine"' in person.get("/mine").text
    other = server.person()
    other.post(f"/annotate/mine/program/{set_up}")
    other.post(f"/annotate/mine/description/{set_up}")
    assert "handed in" in person.get("/annotate/mine").text
    assert person.post(f"/annotate/mine/program/{set_up}").headers["location"] == "/annotate/mine?done=withdrawn"
    assert "Your programs" not in person.get("/annotate/mine").text
    person.post(f"/annotate/mine/description/{set_up}")
    page = person.get("/annotate/mine?done=withdrawn").text
    assert "It is deleted." in page and "You have handed in nothing yet." in page
    assert person.get(f"/annotate/task/{set_up}").status_code == 404


def test_a_description_with_programs_of_others_stays_without_its_author(server, person):
    text, other = described(person), server.person()
    submitted(other, text)
    person.post(f"/annotate/mine/description/{text}")
    assert other.get(f"/annotate/task/{text}").status_code == 200
    assert TEXT["title"] not in person.get("/annotate/mine").text


def test_the_next_step_after_a_description_is_its_program(person):
    text = described(person)
    page = person.get("/annotate/describe?thanks=yes").text
    assert (
        f'href="/annotate/task/{text}"' in page and "You described this." in person.get(f"/annotate/task/{text}").text
    )


def test_a_deleted_session_is_said_to_be_deleted(person):
    answer = person.post("/mine/delete")
    assert "are deleted" in person.get(answer.headers["location"]).text


def offered(person, slot, *things):
    """Return the things of a scene that the page offers for a slot."""
    text = described(person)
    scene(person, text, {"kitchen": 1}, dict.fromkeys(things, 1))
    return [each["name"] for each in person.get(f"/annotate/task/{text}/work").json()["things"] if slot in each["fits"]]


def test_drink_and_eat_are_offered_of_what_one_drinks_and_eats(person):
    things = ("plate", "bowl", "sink", "vase", "milk", "cup", "water_bottle", "food_cake")
    assert offered(person, "Drink 0", *things) == ["milk", "cup", "water_bottle"]
    assert offered(person, "Eat 0", *things) == ["food_cake"]


def ran(person, steps, props, rooms=None):
    text = described(person)
    scene(person, text, rooms or ROOMS, props)
    return post(person, text, "run", steps).json()


SOFA = [["sofa", 1]]


@pytest.mark.parametrize("rest", ["Sit", "Lie"])
def test_who_rests_is_advised_to_stand_up(person, rest):
    steps = [{"special": "hum"}, {"action": "Walk", "things": SOFA}, {"action": rest, "things": SOFA},
             {"action": "Walk", "things": [["television", 1]]}]  # fmt: skip
    result = ran(person, steps, {"sofa": 1, "television": 1})
    assert (result["ran"], result["step"]) == (False, 3)
    assert "after step 3; put “Stand up” in between." in result["why"], result["why"]


def test_a_run_names_what_it_left_out_and_what_was_put_where(person):
    steps = [{"action": "Walk", "things": [["book", 1]]}, {"special": "dream about the sea"},
             {"action": "Read", "things": [["book", 1]]}]  # fmt: skip
    result = ran(person, steps, {"book": 1})
    assert result["ran"] and result["left"] == [1], result
    assert [each["step"] for each in result["ticks"]] == [0, 2]
    assert re.search(r"For this run, before its first step: .*\bbook is in the \w+", result["added"]), result["added"]
    assert all(each["changes"] for each in result["ticks"]), "each step says what came of it"


def test_one_word_again_and_again_is_questioned(person):
    data = {"title": "Eat", "description": f"{'the ' * 9}kitchen the banana", "ask": "yes"}
    assert "like words" in person.post("/annotate/describe", data=data).text


def test_a_list_of_tasks_has_spaces_and_a_begun_one_goes_on(person, set_up):
    person.post(f"/annotate/task/{set_up}/save", json={"version": 3, "steps": STEPS[:1]})
    assert "described by you; your program is begun" in person.get("/annotate/tasks").text
    assert ">Go on<span" in person.get("/annotate/mine").text
