"""Homes for other programs: glTF and OBJ, read back by the library that wrote them and by a validator."""

import json
import shutil
import subprocess

import numpy as np
import pytest

from hearth.homes.library import load_graph
from hearth.rendering.scene.gltf_and_obj import write
from hearth.rendering.scene.instances import placed
from hearth.rendering.scene.scene_preparation import PreparedScene
from hearth.schemas.diagnostics import HearthError

trimesh = pytest.importorskip("trimesh", reason="trimesh is not installed: pip install trimesh")

VALIDATE = """
const validator = require('gltf-validator'), fs = require('fs');
validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[2])))
  .then(found => console.log(JSON.stringify(found.issues)));
"""


@pytest.fixture(scope="module")
def scene(knowledge):
    return PreparedScene(load_graph("cedar", knowledge), knowledge).scene()


@pytest.fixture(scope="module")
def file(scene, tmp_path_factory):
    path = tmp_path_factory.mktemp("exchange") / "cedar.glb"
    assert write(scene, path) == len({thing.id for thing in scene.everything})
    return path


def bounds(found, name):
    """The lowest and highest corner of a node with its pieces, in the home."""
    points = []
    for piece in found.graph.transforms.children.get(name, []):
        matrix, key = found.graph[piece]
        points.append(trimesh.transform_points(found.geometry[key].vertices, matrix))
    points = np.concatenate(points)
    return points.min(axis=0), points.max(axis=0)


def test_every_thing_is_a_node_with_its_id_where_we_draw_it(scene, file):
    found = trimesh.load_scene(file)
    edges = found.graph.transforms.edge_data
    nodes = {child: data["metadata"] for (_, child), data in edges.items() if "id" in (data.get("metadata") or {})}
    assert sorted(each["id"] for each in nodes.values()) == sorted(thing.id for thing in scene.everything)
    expected = {}
    for thing in scene.everything:
        expected.setdefault((thing.id, thing.class_name), []).append(placed(thing).bounds())
    for name, extras in nodes.items():
        near = expected[extras["id"], extras["class"]]
        low, high = bounds(found, name)
        assert any(np.allclose(low, a, atol=1e-4) and np.allclose(high, b, atol=1e-4) for a, b in near), name


def test_textures_stand_the_right_way_up(scene, file):
    """The first rows of a picture are at v = 0 in the file, as they are in `Mesh.uvs`."""
    data = file.read_bytes()
    length = int.from_bytes(data[12:16], "little")
    tree, binary = json.loads(data[20 : 20 + length]), data[28 + length :]
    thing = next(thing for thing in scene.everything if thing.class_name == "door")
    node = next(node for node in tree["nodes"] if node.get("extras", {}).get("id") == thing.id)
    mesh = placed(thing)
    found = []
    for child in node["children"]:
        for primitive in tree["meshes"][tree["nodes"][child]["mesh"]]["primitives"]:
            accessor = tree["accessors"][primitive["attributes"]["TEXCOORD_0"]]
            view = tree["bufferViews"][accessor["bufferView"]]
            start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
            found.append(np.frombuffer(binary, "<f4", accessor["count"] * 2, start)[1::2])
    written, drawn = np.unique(np.concatenate(found)), np.unique(mesh.uvs[..., 1].astype("<f4"))
    apart = np.abs(written[:, None] - drawn)
    assert apart.min(1).max() < 1e-4 and apart.min(0).max() < 1e-4


def test_the_same_scene_has_the_same_bytes(scene, file, tmp_path):
    write(scene, tmp_path / "again.glb")
    assert (tmp_path / "again.glb").read_bytes() == file.read_bytes()


def test_an_obj_has_its_colours_beside_it(scene, tmp_path):
    write(scene, tmp_path / "cedar.obj", "obj")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["cedar.mtl", "cedar.obj"]
    assert trimesh.load_scene(tmp_path / "cedar.obj").area > 100


@pytest.mark.parametrize(("name", "form"), [("cedar.fbx", "gltf"), ("cedar", "obj"), ("cedar.glb", "obj")])
def test_other_files_are_refused(scene, tmp_path, name, form):
    with pytest.raises(HearthError, match="UNSUPPORTED_FILE"):
        write(scene, tmp_path / name, form)
    assert not list(tmp_path.iterdir())


@pytest.mark.tools
def test_a_validator_finds_no_fault(file, tmp_path):
    if not shutil.which("npm"):
        pytest.skip("npm is not installed")
    package = "gltf-validator@2.0.0-dev.3.10"
    install = ["npm", "install", "--silent", "--prefix", tmp_path, package]
    if subprocess.run(install, capture_output=True, check=False).returncode:
        pytest.skip("the validator can't be fetched")
    (tmp_path / "validate.js").write_text(VALIDATE)
    shown = subprocess.run(["node", "validate.js", file], cwd=tmp_path, capture_output=True, text=True, check=True)
    issues = json.loads(shown.stdout)
    assert (issues["numErrors"], issues["numWarnings"]) == (0, 0), issues["messages"][:5]
