"""Output: folders are tried before the work, and files are written whole or not at all."""

from pathlib import Path

import pytest

from nullpose.errors import OutputError
from nullpose.files import prepare_folder, replacing, write_text


def test_folder_is_made_with_its_parents(tmp_path: Path) -> None:
    """Missing parents are made, an existing folder is accepted, and nothing is left in it."""
    folder = tmp_path / "a" / "b"
    assert prepare_folder(folder) == folder
    assert prepare_folder(folder) == folder
    assert list(folder.iterdir()) == []


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
