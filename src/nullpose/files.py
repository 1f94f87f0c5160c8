"""Files: outputs are looked at before the work and never left half written; inputs are read in bounds."""

from __future__ import annotations

import csv
import errno
import json
import os
import re
import secrets
import stat
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from itertools import islice
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any, TypeAlias

from nullpose.errors import Fault, OutputError, ScenarioError, require

PlainTable: TypeAlias = dict[str, Any]
"""A table of plain values, as JSON and TOML hold them."""

MOST_BYTES = 10_000_000
"""The largest file that is read, but for certificates and the manifests of studies."""

_MOST_LISTS = 1_500_000  # of a certificate, which may be large: each takes some 64 bytes of memory
_STRING_OR_BRACE = re.compile(r'"(?:[^"\\]|\\.)*"|}')
_LONGEST_KEY = 40  # characters of a key that a message repeats


def read_bytes(path: Path, most: int = MOST_BYTES) -> bytes:
    """Read a file; a device, a pipe or too large a file is refused before it is read.

    Args:
        path: the file.
        most: the largest that is read, bytes.

    Raises:
        OSError: it cannot be read, or may not be.
        ValueError: no file can have that name.
    """
    if not stat.S_ISREG((status := path.stat()).st_mode) and not stat.S_ISDIR(status.st_mode):
        raise OSError(errno.EINVAL, "it is a device or a pipe, must be a regular file")
    if status.st_size <= most:
        with path.open("rb") as file:
            content = file.read(most + 1)
        if len(content) <= most:
            return content
    raise OSError(errno.EFBIG, f"it is larger than {most / 1e6:g} MB, the most that is read")


def parse_json(text: str, **options: Any) -> Any:
    """Parse a JSON text, in which no object gives a key twice, with options of ``json.loads``.

    Raises:
        ScenarioError: it is no JSON, gives a key twice, or would take too much memory.
    """
    place, closed = "", 0

    def table_of(pairs: list[tuple[str, object]]) -> PlainTable:
        nonlocal closed
        closed += 1
        if len(table := dict(pairs)) < len(pairs):
            counts = Counter(key for key, _ in pairs)
            name = json.dumps(next(key for key in counts if counts[key] > 1)[:_LONGEST_KEY])
            raise _DoubledKeyError(f"the key {name} is given twice in one object; keep one")
        return table

    try:
        if text.count("[") + text.count("{") > _MOST_LISTS:
            raise ValueError(f"it has more than {_MOST_LISTS} lists and objects")
        return json.loads(text, object_pairs_hook=table_of, **options)
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        message = f"this is not JSON: {error.msg[:1].lower()}{error.msg[1:]}"
    except (RecursionError, MemoryError):
        message = "lists or objects are nested too deeply to be read"
    except _DoubledKeyError as error:  # in the object that is the next to be closed
        braces = (token.end() for token in _STRING_OR_BRACE.finditer(text) if token[0] == "}")
        lines = text[: next(islice(braces, closed - 1, None))].split("\n")
        place, message = f"line {len(lines)}, column {len(lines[-1])}", str(error)
    except ValueError as error:  # an integer beyond what Python converts, or what an option refuses
        message = str(error)
        message = "a number has too many digits; write it as in 1e-3" if "digits" in message else message
    raise ScenarioError([Fault(place, message)])


class _DoubledKeyError(ValueError):
    """An object of JSON that gives a key twice."""


def json_text(value: object, indent: int | None = 2) -> str:
    """Write plain data as JSON in ASCII; a number that JSON lacks (NaN, infinities) becomes null."""
    return json.dumps(
        json.loads(json.dumps(value, default=dict), parse_constant=lambda _: None), indent=indent
    )


def check_outputs(inputs: Mapping[str, Path], outputs: Iterable[tuple[str, Path | None]]) -> None:
    """Make sure, before any work, that files can be written and that no two of them are one.

    Args:
        inputs: the files that are read, by what to call them.
        outputs: those that are to be written, each after the option that names it; None where nothing is.

    Raises:
        OutputError: one is an input or another output too, is a folder or a device, or its folder cannot be
            made or written.
    """
    taken = list(inputs.items())
    for option, path in outputs:
        if path is None:
            continue
        for other, used in taken:
            require(
                OutputError,
                not _is_same(path, used),
                f"{option}: {path} is the file of {other} too, which would be lost; give another name",
            )
        with refusals(f"{option}: cannot write {path}"):
            prepare_folder(_target(path).parent)
        taken.append((option, path))


def _is_same(path: Path, other: Path) -> bool:
    """Check whether two names lead to one file, or would."""
    with suppress(OSError, ValueError):
        return os.path.samefile(path, other)
    return os.path.realpath(path) == os.path.realpath(other)


def _target(path: Path) -> Path:
    """Follow a name through links to a file, whether it is there or not; refuse all else."""
    target = Path(os.path.realpath(path))
    with suppress(FileNotFoundError, NotADirectoryError):
        if not stat.S_ISREG(target.stat().st_mode):
            raise OSError(errno.EINVAL, "a folder, a device or a pipe is in the way")
    return target


@contextmanager
def refusals(doing: str) -> Iterator[None]:
    """Turn the system's refusals in the block into an OutputError, whose message says what was being done.

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
    """Make a folder and its parents if need be, and see that it can be written; return it.

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

    The suffix is kept, for writers that go by it.

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
    """Write rows, the first with the names of the columns, to a CSV file, whole or not at all; return it.

    Raises:
        OutputError: the file cannot be written.
    """
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows(rows)
    return path


def write_text(path: Path, text: str) -> Path:
    """Write a UTF-8 text file, whole or not at all; return it.

    Raises:
        OutputError: the file cannot be written.
    """
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")
    return path
