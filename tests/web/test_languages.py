"""Participants' pages in each language: every sentence has its translation, and every page says nothing else."""

from __future__ import annotations

import re
from html.parser import HTMLParser

import pytest
from studies.small import SMALL
from web.people import Server
from web.playing import Player

from hearth.challenges.challenge_definition import NAMES, challenge
from hearth.challenges.instruction_object_names import label
from hearth.challenges.published_tasks import tasks
from hearth.kb.loading.load import default
from hearth.simulation.world.bits import indices
from hearth.studies.study import LANGUAGES as STUDY_LANGUAGES
from hearth.web.phrases import ENGLISH, LANGUAGES, MIRRORED, NOT_FOR_PEOPLE, phrases, preferred
from hearth.web.play.game_messages import usable_things
from hearth.web.play.games import Game
from hearth.web.play.play_trials import helpers, trial

OTHERS = [each for each in LANGUAGES if each not in (ENGLISH, MIRRORED)]

MORE = {"failed", "things"}
"""Parts that other languages have more."""

MAY_LACK = {"study.answer_fault", "play.failed", "play.no_task", "refused.field"}
"""Sentences that may leave out a value which is there in English alone."""


def placeholders(said):
    return set(re.findall(r"\{(\w+)\}", said))


@pytest.mark.parametrize("language", OTHERS)
def test_every_sentence_has_its_translation_with_the_same_values(language):
    english, other = phrases(), phrases(language)
    assert set(other) == set(english) | MORE
    for part, sentences in english.items():
        assert set(other[part]) == set(sentences), part
        for name, said in sentences.items():
            assert other[part][name].strip() and placeholders(other[part][name]) <= placeholders(said), name
            if f"{part}.{name}" not in MAY_LACK:
                assert placeholders(other[part][name]) == placeholders(said), f"{part}.{name}"


@pytest.mark.parametrize("language", OTHERS)
def test_no_sentence_is_for_developers(language):
    for part, sentences in phrases(language).items():
        for name, said in sentences.items() if part != "things" else ():
            assert not NOT_FOR_PEOPLE.search(re.sub(r"\{\w+\}", "", said)), f"{part}.{name}: {said}"


@pytest.mark.parametrize("language", OTHERS)
def test_every_thing_and_task_of_the_challenges_has_a_name(language):
    known, wanted = default(), set()
    for name in NAMES:
        wanted |= {kind.asked for kind in challenge(name).grammar.sets.values()}
        homes = set()
        for task in (task for split in challenge(name).splits for task in tasks(name, split, limit=60)):
            if task.home not in homes:
                homes.add(task.home)
                home = Game(trial(task, known), known).start.home
                wanted |= {label(home.classes[i]) for i in indices(usable_things(home))}
    assert sorted(wanted - set(phrases(language)["things"])) == []


def test_every_helper_has_words_for_people():
    assert set(phrases()["helpers"]) == set(helpers()) == set(phrases("de")["helpers"])
    assert len(set(phrases()["helpers"].values())) == len(helpers()), "two helpers have the same words"


def test_a_study_names_a_language_that_there_is():
    assert set(STUDY_LANGUAGES) == set(LANGUAGES)


@pytest.mark.parametrize(
    ("accepted", "expected"),
    [("de-AT,de;q=0.9,en;q=0.8", "de"), ("fr,de;q=0.5", "de"), ("en-US,de", "en"), ("", "en"), ("*;q=0.1", "en")],
)
def test_the_browser_says_which_language_is_preferred(accepted, expected):
    assert preferred(accepted) == expected


class Texts(HTMLParser):
    """The texts of a page's body that people read or hear."""

    def __init__(self):
        super().__init__()
        self.found, self.hidden = [], 0

    def handle_starttag(self, tag, attributes):
        self.hidden += tag in ("script", "style", "title", "kbd")
        self.found += [value for name, value in attributes if name in ("aria-label", "placeholder", "title") and value]

    def handle_endtag(self, tag):
        self.hidden -= tag in ("script", "style", "title", "kbd")

    def handle_data(self, data):
        if not self.hidden and any(map(str.isalpha, data)):
            self.found.append(data.strip())


OF_STUDY = re.compile("You may stop|A small study|The home|You act for|helpful|hurting|old|young|What else|Hearth")
"""The study's own words, which its researcher writes, and names."""


def untranslated(page):
    """The texts of a page that are not from the table: those of the mirrored English stand in brackets."""
    parser = Texts()
    while page != (page := re.sub("⟦[^⟦⟧]*⟧", "", page)):  # a link within a sentence is a sentence of its own
        pass
    parser.feed(page)
    return [each for each in parser.found if any(map(str.isalpha, each)) and not OF_STUDY.search(each)]


@pytest.fixture
def studied(tmp_path, knowledge):
    """A function that starts a study whose pages have a language, and returns the server and a person."""
    made = []

    def start(language):
        named = f"language: {language}\n" if language else ""
        (tmp_path / "study.yaml").write_text(SMALL + named)
        made.append(Server(tmp_path / "served", knowledge, study=tmp_path / "study.yaml"))
        return made[-1], made[-1].person()

    yield start
    for each in made:
        each.store.close()


def way(person):
    """Every page on the way of a person who takes part."""
    html = {"accept": "text/html"}
    yield person.get("/study/", headers=html).text
    person.post("/study/agree", data={"agree": "yes"})
    yield person.get("/study/", headers=html).text
    person.post("/study/understood")
    while "/study/begin" in (page := person.get("/study/", headers=html).text):
        yield page
        where = person.post("/study/begin").headers["location"]
        yield re.sub('<ul id="goal">.*?</ul>|<h1>.*?</h1>', "", person.get(where, headers=html).text, flags=re.DOTALL)
        with Player(person, where.rpartition("/")[2]) as player:
            player.ask({"type": "finish"})
        if "answer-helpful" in (page := person.get("/study/", headers=html).text):
            yield page
            yield person.post("/study/answer", data={"answer-helpful": "9"}, headers=html).text
            person.post("/study/answer", data={"answer-helpful": "4"})
    yield page
    yield person.get("/mine", headers=html).text.replace(re.search('value="[^"]*/come/', page + 'value="/come/')[0], "")
    person.post("/study/answer", data={})
    yield person.get("/study/", headers=html).text


def test_pages_say_nothing_that_is_not_in_the_table(studied):
    """The mirrored English finds it; these pages are written from right to left."""
    _, person = studied(MIRRORED)
    pages = list(way(person))
    assert len(pages) > 12
    for page in pages:
        assert '<html lang="qps-plocm" dir="rtl">' in page
        assert [each for each in untranslated(page) if not re.fullmatch("[0-9a-f ]+", each)] == []


def test_a_study_in_german_is_german_to_its_end(studied):
    server, person = studied("de")
    pages = list(way(person))
    assert all('<html lang="de" dir="ltr">' in page for page in pages)
    assert "Ich habe das gelesen" in pages[0] and "Vielen Dank" in pages[-1]
    assert server.person().get("/", headers={"accept-language": "de"}).text.count('lang="en"') == 1


def test_the_browser_chooses_where_the_study_does_not(studied):
    server, _ = studied("")
    for accepted, expected in (("de", "Bevor Sie beginnen"), ("en", "Before you begin"), ("fr", "Before you begin")):
        page = server.person().get("/study/", headers={"accept": "text/html", "accept-language": accepted}).text
        assert expected in page
    assert '"language":"de"' in server.client().get("/phrases.js", headers={"accept-language": "de"}).text


def test_things_and_failures_of_a_game_are_german(studied):
    _, person = studied("de")
    person.post("/study/agree", data={"agree": "yes"})
    person.post("/study/understood")
    where = person.post("/study/begin").headers["location"]
    with Player(person, where.rpartition("/")[2]) as player:
        names = {thing[3] for thing in player.state["things"].values()}
        assert {"Küche", "Schlafzimmer"} & {re.sub(r" \d+$", "", name) for name in names}
        assert not any("bedroom" in name or "kitchen" in name for name in names)
        assert all("Put " not in each["text"] for each in player.state["goal"])
