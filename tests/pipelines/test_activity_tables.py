"""Activities and descriptions are those that dictionaries of rows give."""

from __future__ import annotations

from collections import Counter

from hypothesis import given
from hypothesis import strategies as st

from hearth.datasets.format.ids import activity_id
from hearth.pipelines.engine.activity_tables import _WORDS, Activities

names = st.sampled_from(["d1", "d2", "d3", "\u00e9"])
titles = st.sampled_from(["Watch TV", "watch tv", "Read", "?"])
words = {name: st.none() | st.sampled_from(["x", "y"]) for name in _WORDS if name not in ("description_id", "title")}
kinds = st.sampled_from(["program", "description", "sketch", "scene"])
ingested = st.lists(
    st.fixed_dictionaries({**words, "description_id": names, "title": titles, "kind": kinds}), max_size=9
)
parents = st.none() | st.just("p")
published = st.lists(
    st.fixed_dictionaries({"title": titles, "parent_id": parents, "description_id": names}), max_size=9
)


def plain_descriptions(rows, programs):
    """Each description's first row of its own, or else the first of a program; its activity and its originals."""
    described = [row for row in rows if row["kind"] in ("program", "description")]
    found = []
    for name in sorted({row["description_id"] for row in described}):
        mine = [row for row in described if row["description_id"] == name]
        row = next((each for each in mine if each["kind"] == "description"), mine[0])
        count = sum(each["parent_id"] is None and each["description_id"] == name for each in programs)
        kept = {word: row[word] for word in _WORDS}
        found.append({**kept, "activity_id": activity_id(row["title"]), "programs": count})
    return found


def plain_activities(descriptions, programs):
    """Activities of descriptions and programs, with the title most used."""
    found = []
    for name in sorted({each["activity_id"] for each in (*descriptions, *programs)}):
        mine = [each for each in descriptions if each["activity_id"] == name]
        ours = [each for each in programs if each["activity_id"] == name]
        used = Counter(each["title"] for each in (*mine, *ours))
        title = min(used, key=lambda title: (-used[title], title))
        scenes = sorted({each["scene"] for each in mine if each["scene"]})
        row = {"activity_id": name, "title": title, "scenes": scenes}
        found.append({**row, "descriptions": len(mine), "programs": len(ours)})
    return found


@given(ingested, published)
def test_they_are_those_of_dictionaries(rows, programs):
    programs = [{**each, "activity_id": activity_id(each["title"])} for each in programs]
    found = Activities(lambda columns: ({name: row[name] for name in columns} for row in rows), programs)
    descriptions = plain_descriptions(rows, programs)
    assert list(found.description_rows()) == descriptions
    assert list(found.activity_rows()) == plain_activities(descriptions, programs)
