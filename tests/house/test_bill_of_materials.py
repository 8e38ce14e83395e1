"""The bill of materials has every library of the lock, once a version, with each hash."""

import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def written(path):
    subprocess.run([sys.executable, ROOT / "docs/hooks/bill_of_materials.py", path], check=True)
    return path.read_bytes()


def test_every_pin_and_hash_of_the_lock_is_in_the_bill(tmp_path):
    lock = (ROOT / "requirements.lock").read_text()
    bill = json.loads(written(tmp_path / "dist/one.json"))
    assert (bill["bomFormat"], bill["specVersion"]) == ("CycloneDX", "1.5")
    pins = re.findall(r"^([\w.-]+)(?:\[.*?\])?==([\w.!+]+)", lock, re.M)
    assert len(pins) > 50
    assert [(each["name"], each["version"]) for each in bill["components"]] == [
        (re.sub(r"[-_.]+", "-", name).lower(), version) for name, version in pins
    ]
    hashes = [one["hashes"][0]["content"] for each in bill["components"] for one in each["externalReferences"]]
    assert hashes == re.findall(r"sha256:([0-9a-f]{64})", lock)


def test_the_same_lock_gives_the_same_bytes(tmp_path):
    assert written(tmp_path / "one.json") == written(tmp_path / "two.json")


def test_each_component_has_a_reference_of_its_own(tmp_path):
    found = [each["bom-ref"] for each in json.loads(written(tmp_path / "one.json"))["components"]]
    assert len(found) == len({*found})


def test_make_writes_it():
    text = (ROOT / "Makefile").read_text()
    assert "docs/hooks/bill_of_materials.py dist/hearth-sbom.cdx.json" in text
