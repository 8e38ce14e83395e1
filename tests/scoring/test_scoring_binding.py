from hearth.schemas.syntax import parse_program, print_lines
from hearth.scoring.metrics.final_graph import Nodes
from hearth.scoring.predicted_nodes import bind


def bound(text, flat, knowledge, reference=None):
    program, _ = parse_program(text)
    other = parse_program(reference)[0] if reference else None
    return list(print_lines(bind(program, Nodes.of(flat.nodes), knowledge, other)))


def test_a_named_node_stays(flat, knowledge):
    assert bound("[Grab] <cup> (1.21)\n[Grab] <cup> (2.99)", flat, knowledge) == [
        "[Grab] <cup> (1.21)",
        "[Grab] <cup> (2.99)",
    ]


def test_the_references_objects_are_meant_by_their_names(flat, knowledge):
    assert bound("[Grab] <cup> (1)", flat, knowledge, "[Grab] <cup> (1.21)") == ["[Grab] <cup> (1.21)"]
    assert bound("[Grab] <cup> (20)", flat, knowledge, "[Grab] <cup> (20.21)") == ["[Grab] <cup> (20.21)"]


def test_a_number_may_be_a_nodes_id(flat, knowledge):
    assert bound("[Grab] <cup> (21)", flat, knowledge) == ["[Grab] <cup> (21.21)"]
    assert bound("[Grab] <cup> (11)", flat, knowledge) == ["[Grab] <cup> (11.20)"]  # 11 is the fridge


def test_the_first_free_instance_otherwise(flat, knowledge):
    text = "[Grab] <cup> (1)\n[Grab] <cup> (2)\n[Grab] <cup> (1)"
    assert bound(text, flat, knowledge) == ["[Grab] <cup> (1.20)", "[Grab] <cup> (2.21)", "[Grab] <cup> (1.20)"]
    assert bound("[Grab] <cup> (1)\n[Grab] <cup> (2.20)", flat, knowledge)[0] == "[Grab] <cup> (1.21)"


def test_nothing_left_is_no_node(flat, knowledge):
    text = "[Walk] <fridge> (1)\n[Walk] <fridge> (2)\n[Walk] <piano> (1)"
    assert bound(text, flat, knowledge) == ["[Walk] <fridge> (1.11)", "[Walk] <fridge> (2)", "[Walk] <piano> (1)"]


def test_another_name_of_the_same_thing_is_found(flat, knowledge):
    assert "television" in knowledge.same_class("tv")
    assert bound("[Walk] <tv> (1)", flat, knowledge) == ["[Walk] <tv> (1.22)"]
