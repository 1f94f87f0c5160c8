"""Output folders and files: refused before the work starts, and never left half written."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryFile

from nullpose.errors import OutputError

__all__ = ["prepare_folder", "replacing", "write_text"]


def _reason(error: OSError) -> str:
    return error.strerror or str(error)


def prepare_folder(folder: Path) -> Path:
    """Return a folder that exists and can be written, making it and its parents if need be.

    Args:
        folder: where results are to go.

    Raises:
        OutputError: a file is in the way, or the folder cannot be made or written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with TemporaryFile(dir=folder):
            pass
    except FileExistsError as error:
        raise OutputError(
            f"cannot write to the folder {folder}: a file of that name is in the way"
        ) from error
    except OSError as error:
        raise OutputError(f"cannot write to the folder {folder}: {_reason(error)}") from error
    return folder


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a temporary name beside a file; what is written there replaces the file if all goes well.

    Args:
        path: the file to write; its suffix is kept, for writers that go by it.

    Raises:
        OutputError: the file cannot be written.
    """
    temporary = path.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")
    try:
        yield temporary
        os.replace(temporary, path)
    except OSError as error:
        raise OutputError(f"cannot write {path}: {_reason(error)}") from error
    finally:
        temporary.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> Path:
    """Return the path of a UTF-8 text file after writing it whole or not at all.

    Args:
        path: the file to write.
        text: what it is to hold.

    Raises:
        OutputError: the file cannot be written.
    """
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")
    return path
