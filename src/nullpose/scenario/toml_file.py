"""Scenario files as TOML: reading and writing them, and what is wrong with those that cannot be read."""

from __future__ import annotations

import json
import os
import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from nullpose.files import MOST_BYTES, PlainTable, read_bytes
from nullpose.scenario.faults import described, nearest, refusal, require

_TOML_PLACE = re.compile(r"\s*\(at (?:(line \d+, column \d+)|end of document)\)$")
_KEY_TUPLE = re.compile(r"\('([^)]*?)',?\)")
_HINTS = {
    "Cannot overwrite a value": "a key is given twice; keep one",
    "Cannot declare": "a table is headed twice; lists of tables, such as [[nodes]], take double brackets",
    "Invalid value": "texts stand in quotes, lists in brackets, and numbers are written as in 8.0 or 1e-3",
    "Expected '=' after a key": "lines are written as in power_w = 1.0",
    "Invalid statement": "lines are written as in power_w = 1.0",
    "Expected newline": "every key stands on a line of its own",
}
# Of an upload: Python's reader takes memory by the square of a key's parts, and much for a long number.
_MOST_PARTS = 64
_LONGEST_WORD = 10_000
_MOST_KEYS = 200_000  # each takes the reader some 5 microseconds; 10,000 nodes have 120,000 at most
_NO_WORD = re.compile(  # comments, and texts, which may be a part of a key; an open one goes on to its end
    r"""\"{3}(?:[^\\]|\\.)*?(?:"{3,5}|\Z)|'{3}.*?(?:'{3,5}|\Z)|"(?:[^"\\\n]|\\[^\n])*"?|'[^'\n]*'?|\#[^\n]*""",
    re.DOTALL,
)
_WORD = re.compile(r"[\w\-. \t]+")


@dataclass(frozen=True, slots=True)
class FileKind:
    """A kind of file: what it is called, what it is usually named, and how such names end."""

    noun: str
    usual_name: str
    endings: tuple[str, ...] = (".toml",)


SCENARIO_FILE = FileKind("a scenario file", "scenario.toml")


def tables_of(text: str) -> PlainTable:
    """Read the tables of a TOML text.

    Raises:
        ScenarioError: it is no TOML.
    """
    place = ""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        found = _TOML_PLACE.search(str(error))
        words = _KEY_TUPLE.sub(lambda keys: keys[1].replace("', '", "."), _TOML_PLACE.sub("", str(error)))
        lines = text.splitlines() or [""]
        end = f"line {len(lines)}, column {len(lines[-1]) + 1}"
        place = found[1] if found and found[1] else end
        hint = next((f" ({hint})" for start, hint in _HINTS.items() if words.startswith(start)), "")
        message = f"this is not TOML: {words[:1].lower()}{words[1:]}{hint}"
    except (RecursionError, MemoryError):
        message = "lists or tables are nested too deeply to be read"
    except ValueError:  # an integer beyond what Python converts
        message = "a number has too many digits; write it as in 1e-3"
    raise refusal(place, message)


def uploaded_text(content: bytes) -> str:
    """Decode an upload that is TOML, if it takes neither much time nor much memory to read.

    Raises:
        ScenarioError: it is no text, or it does.
    """
    require(
        len(content) <= MOST_BYTES, "", f"it is larger than {MOST_BYTES / 1e6:g} MB, the most that is read"
    )
    text = decoded(content)
    require(text.count("=") <= _MOST_KEYS, "", f"it has more than {_MOST_KEYS} keys, the most that is read")
    is_suspect = any(map(_is_monstrous, text.split("\n")))
    words = _WORD.findall(_NO_WORD.sub("text", text)) if is_suspect else ()
    require(
        not any(map(_is_monstrous, words)),
        "",
        f"a key has more than {_MOST_PARTS} parts, or a word more than {_LONGEST_WORD} characters",
    )
    return text


def _is_monstrous(text: str) -> bool:
    return len(text) > _LONGEST_WORD or text.count(".") > _MOST_PARTS


def file_text(path: Path, kind: FileKind = SCENARIO_FILE, base: Path = Path(), place: str = "") -> str:
    """Return the text of a file, of 10 MB at most.

    Args:
        path: the file.
        kind: what it should be; files of this kind are suggested in place of one that is not there.
        base: the folder from which these are named.
        place: where the file is named, for messages.

    Raises:
        ScenarioError: it cannot be read, or is no text.
    """
    return decoded(file_content(path, kind, base, place))


def file_content(
    path: Path, kind: FileKind, base: Path = Path(), place: str = "", most: int = MOST_BYTES
) -> bytes:
    """Read a file.

    Args:
        path: the file.
        kind: what it should be, as for :func:`file_text`.
        base: the folder from which files are named that are suggested in its place.
        place: where the file is named, for messages.
        most: the largest file that is read, bytes.

    Raises:
        ScenarioError: it cannot be read.
    """
    try:
        return read_bytes(path, most)
    except FileNotFoundError:
        message = f"there is no such file{_other_file(path, kind, base)}"
    except IsADirectoryError:
        message = f"this is a folder, must be {kind.noun}{_other_file(path / kind.usual_name, kind, base)}"
    except OSError as error:
        reason = error.strerror or "unknown reason"
        message = (
            f"the file cannot be read ({reason[:1].lower()}{reason[1:]}); check its name and permissions"
        )
    except ValueError:  # a null character in the name
        message = "this cannot be the name of a file"
    raise refusal(place, message)


def decoded(content: bytes) -> str:
    """Return the text of some bytes, which is UTF-8.

    Raises:
        ScenarioError: it is no text.
    """
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        got = f"byte 0x{content[error.start]:02x}"
        raise refusal(f"line {line}", f"{got} is not UTF-8 text; save the file as UTF-8") from None


def _other_file(path: Path, kind: FileKind, base: Path) -> str:
    """Suggest another file in place of one that is not there."""
    try:
        names = sorted(entry.name for entry in path.parent.iterdir() if entry.suffix in kind.endings)
    except OSError:
        return f", nor a folder {path.parent} that can be read; check the path"
    guess = nearest(path.name, names) or (names[0] if len(names) == 1 else "")
    seen = path.parent / guess
    suggested = seen.relative_to(base) if seen.is_relative_to(base) else seen
    return f"; did you mean {suggested}?" if guess else "; check the path"


def inside(folder: Path, file: str, allow_outside: bool, place: str = "") -> Path:
    """Locate a file that another one names.

    Args:
        folder: of the file that names it.
        file: as it is named.
        allow_outside: whether it may be anywhere.
        place: where it is named, for messages.

    Raises:
        ScenarioError: it is, through links or not, neither in that folder nor below it.
    """
    # A null character, which no path may hold, is told of when the file is read.
    real, root = os.path.realpath(folder / file.replace("\0", "")), os.path.realpath(folder)
    require(
        allow_outside or Path(real).is_relative_to(root),
        place,
        f"got {described(file)}, which is outside the folder of the file that names it; put it there, or "
        "allow this by --allow-outside (in Python allow_outside=True)",
    )
    return folder / file


def toml_text(scenario: Mapping[str, object]) -> str:
    """Return the TOML text of plain values nested as in a scenario file: keys, tables, lists of tables."""
    return "\n\n".join(_blocks([], "", scenario)) + "\n"


def _blocks(header: list[str], path: str, values: Mapping[str, object]) -> Iterator[str]:
    """Yield a table's own keys under its header, then the tables inside it under theirs."""
    tables = {
        key: [value] if isinstance(value, Mapping) else value
        for key, value in values.items()
        if isinstance(value, Mapping)
        or (isinstance(value, list) and all(isinstance(member, Mapping) for member in value))
    }
    yield "\n".join(header + [f"{key} = {toml_value(values[key])}" for key in values if key not in tables])
    for key, inner in tables.items():
        name = f"{path}.{key}".removeprefix(".")
        for table in inner:
            yield from _blocks([f"[{name}]" if values[key] is table else f"[[{name}]]"], name, table)


def toml_value(value: object) -> str:
    """Return one text, number or list in TOML."""
    if isinstance(value, str):
        # JSON's texts are TOML's too, but for the delete character, which TOML wants escaped.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Sequence):
        return f"[{', '.join(toml_value(member) for member in value)}]"
    return repr(value)
