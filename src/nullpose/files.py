"""Files: outputs are looked at before the work and never left half written; inputs are read in bounds."""

from __future__ import annotations

import csv
import errno
import json
import os
import secrets
import stat
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any

from nullpose.errors import Fault, OutputError, ScenarioError

MOST_BYTES = 10_000_000
"""The largest file that is read, but for certificates and the manifests of studies."""

_MOST_LISTS = 1_500_000  # each takes some 64 bytes of memory, however short it is in the file
_LONGEST_KEY = 40  # characters of a key that a message repeats


def read_bytes(path: Path, most: int = MOST_BYTES) -> bytes:
    """Return what a file holds; a device, a pipe or too large a file is refused before it is read.

    Args:
        path: the file.
        most: the largest that is read, bytes.

    Raises:
        OSError: it cannot be read, or may not be.
        ValueError: no file can have that name.
    """
    status = path.stat()
    if not stat.S_ISREG(status.st_mode) and not stat.S_ISDIR(status.st_mode):
        raise OSError(errno.EINVAL, "it is a device or a pipe, must be a regular file")
    if status.st_size <= most:
        with path.open("rb") as file:
            content = file.read(most + 1)
        if len(content) <= most:
            return content
    raise OSError(errno.EFBIG, f"it is larger than {most / 1e6:g} MB, the most that is read")


def parse_json(text: str, **options: Any) -> Any:
    """Return what a JSON text holds, in which no object gives a key twice.

    Args:
        text: the JSON.
        options: further ones of ``json.loads``.

    Raises:
        ScenarioError: it is no JSON, gives a key twice, or would take too much memory.
    """
    repeated: list[tuple[object, str]] = []

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        table = dict(pairs)
        if len(table) < len(pairs) and not repeated:
            counts = Counter(key for key, _ in pairs)
            repeated.append((table, next(key for key in counts if counts[key] > 1)))
        return table

    place, message = "", f"it has more than {_MOST_LISTS} lists and objects"
    try:
        if text.count("[") + text.count("{") <= _MOST_LISTS:
            value = json.loads(text, object_pairs_hook=unique, **options)
            if not repeated:
                return value
            place = _place(value, repeated[0][0]).removeprefix(".")
            message = (
                f"the key {json.dumps(repeated[0][1][:_LONGEST_KEY])} is given twice in one object; keep one"
            )
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        message = f"this is not JSON: {error.msg[:1].lower()}{error.msg[1:]}"
    except RecursionError:
        message = "lists or objects are nested too deeply to be read"
    except ValueError as error:  # an integer beyond what Python converts, or what an option refuses
        message = (
            "a number has too many digits; write it as in 1e-3" if "digits" in str(error) else str(error)
        )
    raise ScenarioError([Fault(place, message)])


def _place(value: object, wanted: object, place: str = "") -> str:
    """Return where in some data one of its tables is, as in ``.trees[0]``; nothing if it is the whole."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        here = f"{place}[{key}]" if isinstance(value, list) else f"{place}.{str(key)[:_LONGEST_KEY]}"
        found = here if item is wanted else _place(item, wanted, here)
        if found:
            return found
    return ""


def check_outputs(inputs: Mapping[str, Path], outputs: Mapping[str, Path | None]) -> None:
    """Make sure, before any work, that files can be written and that no two of them are one.

    Args:
        inputs: the files that are read, by what to call them.
        outputs: those that are to be written, by the options that name them; None where nothing is.

    Raises:
        OutputError: one is an input or another output too, is a folder or a device, or its folder cannot be
            made or written.
    """
    taken = dict(inputs)
    for option, path in outputs.items():
        if path is None:
            continue
        for other, used in taken.items():
            if _is_same(path, used):
                raise OutputError(
                    f"{option}: {path} is the file of {other} too, which would be lost; give another name"
                )
        with refusals(f"{option}: cannot write {path}"):
            prepare_folder(_target(path).parent)
        taken[option] = path


def _is_same(one: Path, other: Path) -> bool:
    """Return whether two names lead to one file, or would."""
    with suppress(OSError, ValueError):
        return os.path.samefile(one, other)
    return os.path.realpath(one) == os.path.realpath(other)


def _target(path: Path) -> Path:
    """Return the file that a name leads to through links, whether it is there or not; refuse all else."""
    target = Path(os.path.realpath(path))
    with suppress(FileNotFoundError, NotADirectoryError):
        if not stat.S_ISREG(target.stat().st_mode):
            raise OSError(errno.EINVAL, "a folder, a device or a pipe is in the way")
    return target


@contextmanager
def refusals(doing: str) -> Iterator[None]:
    """Turn the system's refusals in the block into an OutputError.

    Args:
        doing: what is being done, for the message.

    Raises:
        OutputError: the system refused something.
    """
    try:
        yield
    except OutputError:
        raise
    except OSError as error:
        raise OutputError(f"{doing}: {error.strerror or error}") from error


def prepare_folder(folder: Path) -> Path:
    """Return a folder that exists and can be written, making it and its parents if need be.

    Args:
        folder: where results are to go.

    Raises:
        OutputError: a file is in the way, or the folder cannot be made or written.
    """
    with refusals(f"cannot write to the folder {folder}"):
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except FileExistsError as error:
            raise OSError("a file of that name is in the way") from error
        with TemporaryFile(dir=folder):
            pass
    return folder


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a temporary name beside a file; what is written there replaces the file if all goes well.

    Args:
        path: the file to write; its suffix is kept, for writers that go by it.

    Raises:
        OutputError: the file cannot be written.
    """
    with refusals(f"cannot write {path}"):
        target = _target(path)
        # a name that nobody can foresee, so that nobody can have laid a link there
        temporary = target.with_name(f".{target.stem[:100]}.{secrets.token_hex(8)}{target.suffix}")
        try:
            yield temporary
            os.replace(temporary, target)
        finally:
            temporary.unlink(missing_ok=True)


def write_csv(path: Path, rows: Iterable[Iterable[object]]) -> Path:
    """Return the path of a CSV file after writing rows to it, whole or not at all.

    Args:
        path: the file to write.
        rows: the names of the columns, then the cells.

    Raises:
        OutputError: the file cannot be written.
    """
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows(rows)
    return path


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
