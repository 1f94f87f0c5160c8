"""Outputs are tried before the work and written whole or not at all; inputs are read in bounds."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from nullpose.errors import OutputError, ScenarioError
from nullpose.files import check_outputs, parse_json, prepare_folder, read_bytes, replacing, write_text


@pytest.mark.parametrize("below", ["", "deeper"])
def test_file_in_the_way(tmp_path: Path, below: str) -> None:
    """A file where a folder is needed is told apart from other troubles."""
    (tmp_path / "file").write_text("mine", encoding="utf-8")
    with pytest.raises(OutputError, match="cannot write to the folder"):
        prepare_folder(tmp_path / "file" / below)
    assert (tmp_path / "file").read_text(encoding="utf-8") == "mine"


def test_folder_that_refuses_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder in which no file can be made is refused with the system's reason."""

    def refuse(**_: object) -> object:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("nullpose.files.TemporaryFile", refuse)
    with pytest.raises(OutputError, match="Permission denied"):
        prepare_folder(tmp_path)


def test_file_is_replaced_when_all_went_well(tmp_path: Path) -> None:
    """The new text takes the place of the old, and no other file is left."""
    path = tmp_path / "a.txt"
    path.write_text("old", encoding="utf-8")
    write_text(path, "new, ünïcode\n")
    assert path.read_text(encoding="utf-8") == "new, ünïcode\n"
    assert list(tmp_path.iterdir()) == [path]


def _write_half(path: Path) -> None:
    with replacing(path) as temporary:
        temporary.write_text("half", encoding="utf-8")
        raise ArithmeticError("half way")


def test_file_is_kept_when_writing_fails(tmp_path: Path) -> None:
    """An error half way leaves the old file as it was, and no other."""
    path = tmp_path / "a.txt"
    path.write_text("old", encoding="utf-8")
    with pytest.raises(ArithmeticError, match="half way"):
        _write_half(path)
    assert path.read_text(encoding="utf-8") == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_file_that_cannot_be_written(tmp_path: Path) -> None:
    """A folder that is gone by the time of writing is an output error, not a traceback."""
    with pytest.raises(OutputError, match="cannot write"):
        write_text(tmp_path / "gone" / "a.txt", "text")


def test_a_full_disk_leaves_the_old_file(tmp_path: Path) -> None:
    """A file that grows beyond what the system allows is refused; the old one stays, and no other."""
    path = tmp_path / "a.txt"
    path.write_text("old", encoding="utf-8")
    code = (
        "import resource, signal, sys; from pathlib import Path; from nullpose.files import write_text\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN); resource.setrlimit(resource.RLIMIT_FSIZE, (9, 9))\n"
        "write_text(Path(sys.argv[1]), 'x' * 100_000)"
    )
    done = subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True, check=False)
    assert f"OutputError: cannot write {path}: File too large" in done.stderr
    assert path.read_text(encoding="utf-8") == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_link_is_followed(tmp_path: Path) -> None:
    """What a link leads to is replaced, and the link stays one."""
    (tmp_path / "folder").mkdir()
    (tmp_path / "link.txt").symlink_to(tmp_path / "folder" / "a.txt")
    write_text(tmp_path / "link.txt", "new")
    assert (tmp_path / "link.txt").is_symlink()
    assert (tmp_path / "folder" / "a.txt").read_text(encoding="utf-8") == "new"


@pytest.mark.parametrize("kind", ["folder", "pipe", "device"])
def test_what_is_no_file_is_never_replaced(tmp_path: Path, kind: str) -> None:
    """Neither a folder nor a pipe nor a device makes way for an output, before the work or after it."""
    path = tmp_path / kind
    if kind == "folder":
        path.mkdir()
    elif kind == "pipe":
        os.mkfifo(path)
    else:
        path.symlink_to("/dev/null")
    before = path.stat()
    with pytest.raises(OutputError, match=r"cannot write .* a folder, a device or a pipe is in the way"):
        write_text(path, "text")
    with pytest.raises(OutputError, match=r"--figure: cannot write .* is in the way"):
        check_outputs({}, [("--figure", path)])
    assert os.path.samestat(before, path.stat())


@pytest.mark.parametrize("way", ["plain", "dots", "link", "hard link", "linked folder"])
def test_one_file_is_not_two(tmp_path: Path, way: str) -> None:
    """An output that is an input or another output, by whatever name, is refused, and both are named."""
    folder = tmp_path / "folder"
    folder.mkdir()
    file, other = folder / "a.toml", folder / "a.toml"
    file.touch()
    if way == "dots":
        other = folder / ".." / "folder" / "a.toml"
    elif way == "link":
        other = tmp_path / "link"
        other.symlink_to(file)
    elif way == "hard link":
        other = tmp_path / "hard"
        other.hardlink_to(file)
    elif way == "linked folder":
        (tmp_path / "linked").symlink_to(folder)
        other = tmp_path / "linked" / "a.toml"
    with pytest.raises(OutputError, match=r"--certificate: .* is the file of the scenario too"):
        check_outputs({"the scenario": file}, [("--certificate", other)])
    if way != "hard link":  # there is none of what is not there
        file.unlink()
    with pytest.raises(OutputError, match=r"--figure: .* is the file of --certificate too"):
        check_outputs({}, [("--certificate", file), ("--figure", other)])


def test_reading_is_bounded(tmp_path: Path) -> None:
    """As many bytes as are allowed are read; one more, and the file is refused, as is what has no end."""
    path = tmp_path / "a"
    path.write_bytes(b"12345")
    assert read_bytes(path, 5) == b"12345"
    with pytest.raises(OSError, match=r"larger than 4e-06 MB"):
        read_bytes(path, 4)
    os.mkfifo(tmp_path / "pipe")
    for endless in (tmp_path / "pipe", Path("/dev/zero")):
        with pytest.raises(OSError, match="a device or a pipe"):
            read_bytes(endless, 5)


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        ('{"a": 1, "a": 2}', "line 1, column 16", 'the key "a" is given twice in one object; keep one'),
        ('[{"a": 1},\n {"}": {"a": 1,\n "a": 2}}, {"c": 1, "c": 2}]', "line 3, column 8", 'the key "a" is'),
        ('{"a": {"b": [1, {"c": 1, "d": 2, "c": 3}]}}', "line 1, column 40", 'the key "c" is given twice'),
        ('[[{"a": 1, "a": 1}]]', "line 1, column 18", 'the key "a" is given twice'),
        ("[" * 100_000, "", "nested too deeply"),
        ("[" + "9" * 10_000 + "]", "", "too many digits"),
        ("{\n]", "line 2, column 1", "this is not JSON: "),
    ],
)
def test_json_is_read_in_bounds(text: str, place: str, words: str) -> None:
    """What says a thing twice, or is nested without end, is refused."""
    with pytest.raises(ScenarioError) as caught:
        parse_json(text)
    (fault,) = caught.value.faults
    assert fault.path == place
    assert words in fault.message
