"""A build into a real S3-compatible server on the loopback, by a pool and by a dask cluster; verified, queried."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

import pytest

pytestmark = pytest.mark.tools
moto = pytest.importorskip("moto.server")
s3fs = pytest.importorskip("s3fs")


@pytest.fixture(scope="module")
def server():
    """moto's server, in a thread, on a port of its own."""
    running = moto.ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    running.start()
    host, port = running.get_host_and_port()
    yield f"http://{host}:{port}"
    running.stop()


@pytest.fixture
def run(server, request):
    """Run the command line against the server, as somebody who has only this much set up."""
    here = {"AWS_ACCESS_KEY_ID": "x", "AWS_SECRET_ACCESS_KEY": "x", "AWS_DEFAULT_REGION": "us-east-1"}
    work = tempfile.mkdtemp(prefix="h")  # short: sockets of worker processes stand below it
    environment = {**os.environ, **here, "AWS_ENDPOINT_URL": server, "TMPDIR": work}
    cli = request.config.rootpath / "cli.py"

    def command(*words: str, status: int = 0) -> str:
        asked = [sys.executable, str(cli), *map(str, words)]
        done = subprocess.run(asked, env=environment, capture_output=True, text=True, timeout=900, check=False)
        assert done.returncode == status, done.stderr
        return done.stdout + done.stderr

    command.environment = environment
    yield command
    shutil.rmtree(work)


@pytest.fixture
def bucket(server):
    filesystem = s3fs.S3FileSystem(key="x", secret="x", endpoint_url=server, skip_instance_cache=True)
    filesystem.mkdir("homes")
    yield filesystem
    filesystem.rm("homes", recursive=True)


def homes_of(made):
    """Return the options of the golden dataset, which is of action set 2 and has no pictures."""
    folder = made.settings.homes_folder
    return "--homes", folder, "--home", "cabin", "--action-set", "2", "--pictures", "0", "--videos", "0"


@pytest.mark.parametrize("engine", ["local", "dask"])
def test_built_verified_and_queried(run, bucket, made, engine):
    if engine == "dask":
        pytest.importorskip("distributed")
    homes = homes_of(made)
    bucket.put(str(made.settings.sources[1]), "homes/in/evening.txt")
    sources = [made.settings.sources[0], "s3://homes/in/evening.txt", made.settings.sources[2]]
    run("build", *sources, "--out", "s3://homes/evening", *homes, "--workers", "2", "--engine", engine)
    files = ("publish/programs/part-00000.train.parquet", "publish/manifest.json", "sample/part-00002.parquet")
    for name in files:
        assert bucket.cat(f"homes/evening/{name}") == (made.out / name).read_bytes(), name
    assert not bucket.exists("homes/evening/.lock")
    assert ": no faults" in run("verify", "s3://homes/evening")
    assert str(len(made.rows("publish/programs"))) in run(
        "query", "s3://homes/evening", "SELECT count(*) AS programs FROM programs"
    )
    bucket.pipe_file("homes/evening/publish/programs/part-00000.train.parquet", b"damaged")
    assert "programs/part-00000.train.parquet" in run("verify", "s3://homes/evening", status=1)


READER = """
import sys
from pathlib import Path
import hearth

opened, failed, keys = 0, [], set()
Path(sys.argv[2]).touch()
while not Path(sys.argv[1]).exists():
    try:
        ds = hearth.load("s3://homes/evening")
        (first, *_) = ds
        ds[first].runs[0].final
        ds.rows("SELECT count(*) FROM executions JOIN programs USING (program_id)")
        keys.add(ds.manifest["key"])
    except Exception as error:
        failed.append(repr(error))
    opened += 1
print(opened, len(failed), ",".join(keys), failed[:3])
"""


def test_eight_readers_while_a_dataset_is_replaced(run, bucket, made, tmp_path):
    homes = homes_of(made)
    run("build", *made.settings.sources, "--out", "s3://homes/evening", *homes)
    (tmp_path / "reader.py").write_text(READER)
    done, ready = tmp_path / "done", [tmp_path / f"ready{number}" for number in range(8)]
    asked = [[sys.executable, str(tmp_path / "reader.py"), str(done), str(path)] for path in ready]
    readers = [subprocess.Popen(one, stdout=subprocess.PIPE, text=True, env=run.environment) for one in asked]
    while not all(path.exists() for path in ready):
        time.sleep(0.05)
    published = {json.loads(bucket.cat("homes/evening/publish/manifest.json"))["key"]}
    for seed in (1, 2, 3, 4):
        run("publish", "--out", "s3://homes/evening", "--seed", seed)
        bucket.invalidate_cache()
        published.add(json.loads(bucket.cat("homes/evening/publish/manifest.json"))["key"])
    done.touch()
    found = [reader.communicate(timeout=300)[0].split(maxsplit=3) for reader in readers]
    assert len(published) == 5
    assert [(int(failed), why) for _, failed, _, why in found if int(failed)] == []
    assert sum(int(opened) for opened, *_ in found) >= 16
    assert {key for _, _, keys, _ in found for key in keys.split(",")} <= published


def test_a_missing_bucket_is_reported(run, made):
    printed = run("build", made.settings.sources[1], "--out", "s3://nowhere/x", status=1)
    assert "s3://nowhere/x" in printed and "Traceback" not in printed
