"""The possible arguments, found for many nodes at once, are those that a requirement accepts one by one."""

from hypothesis import given
from hypothesis import strategies as st

from hearth.kb.knowledge_records import Requirement
from hearth.simulation.world.affordance import allowed

PROPERTIES, CLASSES = ("CUTTABLE", "EATABLE", "SHARP"), ("knife", "butter_knife", "bread", "kitchen")

some_properties = st.frozensets(st.sampled_from(PROPERTIES), max_size=2)
some_classes = st.frozensets(st.sampled_from(CLASSES), max_size=2)
requirements = st.builds(
    Requirement,
    any_of=some_properties,
    all_of=some_properties,
    classes=some_classes,
    contains=st.sampled_from(((), ("knife",), ("bread", "fork"), ("nothing",))),
    anything=st.booleans(),
    no_rooms=st.booleans(),
    also=some_classes,
    never=some_classes,
)
nodes = st.lists(st.tuples(some_properties, st.sampled_from(CLASSES)), min_size=1, max_size=8)


@given(requirements, nodes)
def test_masks_are_what_each_node_is_accepted_for(needs, given_nodes):
    properties, classes, rooms = dict[str, int](), dict[str, int](), 0
    for n, (names, class_name) in enumerate(given_nodes):
        for name in names:
            properties[name] = properties.get(name, 0) | 1 << n
        classes[class_name] = classes.get(class_name, 0) | 1 << n
        rooms |= (class_name == "kitchen") << n
    every = (1 << len(given_nodes)) - 1
    found = allowed(needs, properties, classes, rooms, every)
    alone = [needs.accepts(names, class_name, class_name == "kitchen") for names, class_name in given_nodes]
    assert found == sum(accepted << n for n, accepted in enumerate(alone))
