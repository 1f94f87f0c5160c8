"""Damage on disk and two runs at once: nothing altered is read, and a further run mends the folder."""

import json
import os
import shutil
import signal
import socket
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from nullpose import OutputError, UsageError
from nullpose.study.monte_carlo import (
    StudyProgress,
    StudySpec,
    load_spec,
    read_study,
    run_study,
    study_status,
)
from nullpose.study.monte_carlo.folder import Folder
from nullpose.study.monte_carlo.rows import read_parquet

Rows = Callable[[Path], pd.DataFrame]
Spec = Callable[..., StudySpec]

SCENES = 60


@pytest.fixture(scope="module")
def done(quick: Spec, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A quick study that is done, in six parts."""
    folder = tmp_path_factory.mktemp("done")
    run_study(quick(scenes=SCENES), folder, workers=0, chunk=10)
    return folder


@pytest.fixture
def study(done: Path, tmp_path: Path) -> Path:
    """Return a copy of it for one test."""
    return shutil.copytree(done, tmp_path / "out")


def _truncated(part: Path) -> None:
    part.write_bytes(part.read_bytes()[:-40])


def _altered(part: Path) -> None:
    content = bytearray(part.read_bytes())
    content[len(content) // 4] ^= 1
    part.write_bytes(content)


def _text(part: Path) -> None:
    part.write_bytes(b"no table")


def _other_columns(part: Path) -> None:
    pd.DataFrame({"scene": [1.0]}).to_parquet(part)


@pytest.mark.parametrize("damage", [_truncated, _altered, _text, _other_columns])
def test_a_damaged_part_is_found_and_done_anew(
    study: Path, rows: Rows, damage: Callable[[Path], None]
) -> None:
    """It is refused by name; a further run solves it again and leaves the other parts alone."""
    before = rows(study)
    parts = sorted((study / "parts").iterdir())
    kept = {part: part.stat().st_mtime_ns for part in parts if part != parts[2]}
    damage(parts[2])
    with pytest.raises(UsageError, match=rf"{parts[2].name}: damaged .*study run"):
        read_study(study).frame()
    notes: list[str] = []
    run_study(read_study(study).spec, study, workers=0, on_progress=lambda at: notes.append(at.note))
    assert "1 part damaged, to be done anew" in notes
    assert {part: part.stat().st_mtime_ns for part in kept} == kept
    pd.testing.assert_frame_equal(rows(study), before)


def test_no_altered_bit_changes_a_row(study: Path) -> None:
    """Wherever a bit of a part is turned, the rows are refused or they are the same."""
    spec, part = read_study(study).spec, sorted((study / "parts").iterdir())[0]
    content, before = part.read_bytes(), read_parquet(spec, part)
    refused = 0
    for place in range(0, len(content), 17):
        part.write_bytes(content[:place] + bytes([content[place] ^ 4]) + content[place + 1 :])
        try:
            table = read_parquet(spec, part)
        except ValueError:
            refused += 1
        else:
            assert table.equals(before), place
    assert refused > 0.3 * len(content) / 17


def test_a_missing_part_is_to_do(study: Path, rows: Rows) -> None:
    """Without it the study is unfinished, and a further run solves it."""
    before = rows(study)
    sorted((study / "parts").iterdir())[2].unlink()
    assert (study_status(study).done, len(rows(study))) == (SCENES - 10, SCENES - 10)
    assert run_study(read_study(study).spec, study, workers=0).complete
    pd.testing.assert_frame_equal(rows(study), before)


def test_leftovers_are_taken_away(study: Path, rows: Rows) -> None:
    """Temporary files and parts of other scenes count for nothing, and a further run removes them."""
    before, parts = rows(study), study / "parts"
    part = sorted(parts.iterdir())[0]
    (parts / ".part-000000000-000000009.999.parquet").write_bytes(b"half")
    (study / ".manifest.999.json").write_bytes(b"half")
    for name in ("part-000000000-000000004.parquet", "part-000001000-000001009.parquet"):
        (parts / name).write_bytes(part.read_bytes())
    assert study_status(study).done == SCENES
    pd.testing.assert_frame_equal(rows(study), before)
    part.unlink()
    run_study(read_study(study).spec, study, workers=0)
    assert len(list(parts.iterdir())) == 6
    assert not list(study.glob(".manifest*"))
    pd.testing.assert_frame_equal(rows(study), before)


def test_what_is_done_is_not_done_again(study: Path) -> None:
    """A further run of a study that is complete writes nothing."""
    before = {path: path.stat().st_mtime_ns for path in study.rglob("*") if path.name != "lock"}
    told: list[StudyProgress] = []
    run_study(read_study(study).spec, study, on_progress=told.append)
    assert {path: path.stat().st_mtime_ns for path in before} == before
    assert [at.done for at in told] == [SCENES]


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A disk of 128 kB."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=128k", "none", str(folder)]
    try:
        made = subprocess.run(mount, capture_output=True, text=True, check=False)
        reason = made.stderr.strip() if made.returncode else ""
    except OSError as error:
        reason = str(error)
    if reason:
        pytest.skip(f"no small disk can be mounted here: {reason}")
    yield folder
    subprocess.run(["umount", str(folder)], check=True)


def test_a_full_disk(small_disk: Path, quick: Spec, tmp_path: Path, rows: Rows) -> None:
    """It is said, nothing half-written stays, and with more space the study goes on."""
    spec, out = quick(scenes=300), small_disk / "out"
    with pytest.raises(OutputError, match=r"cannot write .*: No space left on device"):
        run_study(spec, out, workers=0, chunk=10)
    done = study_status(out).done
    assert 0 < done < 300
    assert not list(out.rglob(".*"))
    assert len(rows(out)) == done
    subprocess.run(["mount", "-o", "remount,size=8m", str(small_disk)], check=True)
    run_study(spec, out, workers=0)
    run_study(spec, tmp_path / "whole", workers=0)
    pd.testing.assert_frame_equal(rows(out), rows(tmp_path / "whole"))


@pytest.mark.grid
def test_a_full_disk_ends_the_program_with_a_message(small_disk: Path, spec_file: Any, farm: Any) -> None:
    """The exit code is that of bad input, and there is no traceback."""
    spec = spec_file(farm.folder, scenes=300)
    client = farm.start(
        "nullpose", "study", "run", spec, "--out", small_disk / "out", "--workers", 2, "--chunk", 10
    )
    said, _ = client.communicate(timeout=farm.LONGEST_S)
    assert client.returncode == 2
    assert "No space left on device" in said
    assert "Traceback" not in said
    farm.until(lambda: not farm.is_there(client.pid))


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("name", 3),
        ("objective", "best"),
        ("objective", None),
        ("scenes", "many"),
        ("scenes", 10**400),
        ("chunk", 0),
        ("spec_sha256", None),
        ("versions", []),
        ("spec", 3),
    ],
)
def test_a_manifest_with_something_wrong_is_refused(study: Path, key: str, value: Any) -> None:
    """Each of its values is checked, and named."""
    path = study / "manifest.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | {key: value}), encoding="utf-8")
    for read in (study_status, read_study):
        with pytest.raises(UsageError, match=rf"manifest\.json: {key} is missing or wrong"):
            read(study)


@pytest.mark.parametrize(
    "content",
    ["[" * 100_000, '{"format": 1, "format": 1}', '{"format": 1, "name": ' + "9" * 5000, "\0", "[]" * 9],
)
def test_a_manifest_that_is_none_is_refused(study: Path, content: str) -> None:
    """Whatever is in its place ends in words."""
    (study / "manifest.json").write_text(content, encoding="utf-8")
    with pytest.raises(UsageError, match=r"manifest\.json: .*restore it|another format"):
        study_status(study)


@pytest.mark.parametrize("name", ["manifest.json", "part", "lock"])
@pytest.mark.parametrize("kind", ["pipe", "device", "folder"])
def test_what_never_ends_is_not_read(study: Path, name: str, kind: str) -> None:
    """A pipe, a device or a folder in the place of a study's file is not waited for."""
    path = sorted((study / "parts").iterdir())[0] if name == "part" else study / name
    path.unlink()
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "device":
        path.symlink_to("/dev/zero")
    else:
        path.mkdir()
    if name == "manifest.json":
        with pytest.raises(UsageError, match=name):
            study_status(study)
    elif name == "lock":
        assert study_status(study).running == ""
        with pytest.raises(OutputError, match="in the way"):
            run_study(read_study(study).spec, study, workers=0)
    else:
        assert study_status(study).done == SCENES - 10


def test_a_second_run_is_refused(farm: Any, spec_file: Any, tmp_path: Path) -> None:
    """It ends with a message that names the first, which goes on; a killed one stops nobody."""
    spec, out = spec_file(tmp_path, scenes=10**6), tmp_path / "out"
    first = farm.start("nullpose", "study", "run", spec, "--out", out, "--workers", 0, "--chunk", 10)
    farm.until(lambda: (out / "parts").exists())
    name = f"process {first.pid} on {socket.gethostname()}"
    assert study_status(out).running == name

    def go_on(at: StudyProgress) -> None:
        raise AssertionError("both write this study")

    with pytest.raises(OutputError, match=f"{name} writes this study now"):
        run_study(load_spec(spec), out, workers=0, on_progress=go_on)
    assert first.poll() is None
    os.killpg(first.pid, signal.SIGKILL)
    first.wait()
    assert study_status(out).running == ""
    with Folder(out).locked():
        pass


def test_a_lock_of_other_bytes_stops_nobody(tmp_path: Path, quick: Spec) -> None:
    """Whatever a dead process left in the file."""
    (tmp_path / "lock").write_bytes(b"process \xff\xaa on here\n")
    assert Folder(tmp_path).owner == ""
    assert run_study(quick(), tmp_path, workers=0).complete
