"""Damage on disk: nothing that is half written or altered is read, and a further run mends it."""

import hashlib
import json
import os
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
    read_study,
    run_study,
    study_spec,
    study_status,
)

Rows = Callable[[Path], pd.DataFrame]
Spec = Callable[..., StudySpec]

SCENES = 60


@pytest.fixture
def study(quick: Spec, tmp_path: Path) -> Path:
    """A quick study that is done, in six parts."""
    run_study(quick(scenes=SCENES), tmp_path / "out", workers=0, chunk=10)
    return tmp_path / "out"


def _truncated(part: Path) -> None:
    part.write_bytes(part.read_bytes()[:-40])


def _altered(part: Path) -> None:
    content = bytearray(part.read_bytes())
    content[len(content) // 2] ^= 1
    part.write_bytes(content)


def _away(part: Path) -> None:
    part.unlink()


@pytest.mark.parametrize("damage", [_truncated, _altered, _away])
def test_a_damaged_part_is_found_and_done_anew(
    study: Path, rows: Rows, damage: Callable[[Path], None]
) -> None:
    """By its size or its checksum; the other parts are left alone."""
    before = rows(study)
    parts = sorted((study / "parts").iterdir())
    kept = {part: part.stat().st_mtime_ns for part in parts if part != parts[2]}
    damage(parts[2])
    with pytest.raises(UsageError, match="damaged or missing"):
        read_study(study).frame()
    notes: list[str] = []
    run_study(read_study(study).spec, study, workers=0, on_progress=lambda at: notes.append(at.note))
    assert "1 part damaged or missing, to be done anew" in notes
    assert {part: part.stat().st_mtime_ns for part in kept} == kept
    pd.testing.assert_frame_equal(rows(study), before)


def test_leftovers_are_taken_away(study: Path, rows: Rows) -> None:
    """Temporary files, parts that are not listed and half a line of the journal leave no trace."""
    before, journal = rows(study), study / "parts.jsonl"
    text = journal.read_text(encoding="utf-8")
    lines = text.splitlines(keepends=True)
    journal.write_text("".join(lines[:-1]) + lines[-1][:25], encoding="utf-8")
    (study / "parts" / ".part-000000000-000000009.999.parquet").write_bytes(b"half")
    (study / ".manifest.999.json").write_bytes(b"half")
    assert study_status(study).done == SCENES - 10
    run_study(read_study(study).spec, study, workers=0)
    listed = [json.loads(line)["first"] for line in journal.read_text(encoding="utf-8").splitlines()]
    assert sorted(listed) == list(range(0, SCENES, 10))
    assert len(list((study / "parts").iterdir())) == 6
    assert not list(study.glob(".manifest*"))
    pd.testing.assert_frame_equal(rows(study), before)


def test_a_part_listed_twice_counts_once(study: Path, rows: Rows) -> None:
    """A line that stands twice in the journal makes no double rows."""
    journal = study / "parts.jsonl"
    lines = journal.read_text(encoding="utf-8").splitlines(keepends=True)
    journal.write_text("".join([*lines, lines[0]]), encoding="utf-8")
    assert study_status(study).rows == SCENES
    assert not rows(study).duplicated(["scene", "point", "case"]).any()


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
    """It is said, nothing half-written stays, and with room again the study goes on."""
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


def test_a_full_disk_ends_the_program_with_a_message(small_disk: Path, spec_file: Any, farm: Any) -> None:
    """The exit code is that of bad input, and there is no traceback."""
    spec = spec_file(farm.folder, scenes=300)
    client = farm.start(
        "nullpose", "study", "run", spec, "--out", small_disk / "out", "--workers", 0, "--chunk", 10
    )
    said, _ = client.communicate(timeout=60)
    assert client.returncode == 2
    assert "No space left on device" in said
    assert "Traceback" not in said


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
    """Each thing that is asked of it is looked at, and named."""
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


@pytest.mark.parametrize("name", ["manifest.json", "parts.jsonl", "lock"])
@pytest.mark.parametrize("kind", ["pipe", "device", "folder"])
def test_what_never_ends_is_not_read(study: Path, name: str, kind: str) -> None:
    """A pipe, a device or a folder in the place of a study's file is refused, not waited for."""
    (study / name).unlink()
    if kind == "pipe":
        os.mkfifo(study / name)
    elif kind == "device":
        (study / name).symlink_to("/dev/zero")
    else:
        (study / name).mkdir()
    if name == "lock":
        assert study_status(study).running == ""
        with pytest.raises(OutputError, match="in the way"):
            run_study(read_study(study).spec, study, workers=0)
    else:
        with pytest.raises(UsageError, match=name):
            study_status(study)


@pytest.mark.parametrize(
    "line",
    [
        "[" * 4000,
        "[" * 1_000_000,
        "{}",
        "3",
        {"first": "0"},
        {"first": -1},
        {"first": 5, "last": 4},
        {"rows": 10**300},
        {"seconds": float("inf")},
        {"sha256": 3},
        {"extra": 1},
    ],
    ids=str,
)
def test_a_line_that_is_none_is_passed_over(study: Path, line: Any) -> None:
    """Whatever stands in the journal, the lines that are sound count, and no others."""
    before, path = study_status(study), study / "parts.jsonl"
    if isinstance(line, dict):
        line = json.dumps(json.loads(path.read_text().splitlines()[0]) | line)
    path.write_text(f"{path.read_text()}{line}\n", encoding="utf-8")
    assert study_status(study) == before


def test_a_part_beyond_the_scenes_is_done_away_with(study: Path, rows: Rows) -> None:
    """A journal that lists more scenes than the study has does not stop a further run."""
    before, path = rows(study), study / "parts.jsonl"
    lines = path.read_text().splitlines()
    last = json.loads(lines[-1])
    part = study / "parts" / f"part-{last['first']:09d}-{last['last']:09d}.parquet"
    last |= {"first": 10**6, "last": 10**6 + 9}
    part.rename(part.with_name("part-001000000-001000009.parquet"))
    path.write_text("\n".join([*lines[:-1], json.dumps(last)]) + "\n", encoding="utf-8")
    assert run_study(study_spec(study), study, workers=0).done >= SCENES
    assert len(before) == SCENES


@pytest.mark.parametrize("content", [b"no table", b""])
def test_a_part_that_is_no_table_is_told(study: Path, content: bytes) -> None:
    """A file whose checksum is the one listed, but which holds other columns or none, is refused by name."""
    path = study / "parts.jsonl"
    lines = [json.loads(line) for line in path.read_text().splitlines()]
    part = sorted((study / "parts").iterdir())[0]
    if content:
        part.write_bytes(content)
    else:
        pd.DataFrame({"scene": [1.0]}).to_parquet(part)
    content = part.read_bytes()
    lines[0] |= {"size": len(content), "sha256": hashlib.sha256(content).hexdigest()}
    path.write_text("\n".join(map(json.dumps, lines)) + "\n", encoding="utf-8")
    with pytest.raises(UsageError, match=rf"{part.name}: (cannot be read|has other columns)"):
        read_study(study).frame()
