"""From a file to a scenario."""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from nullpose.errors import Fault, ScenarioError
from nullpose.files import MOST_BYTES, read_bytes
from nullpose.scenario.listed_nodes import ListedNodes, NodesFileError
from nullpose.scenario.nodes_file import KINDS, reader_of
from nullpose.scenario.scenario import Scenario
from nullpose.scenario.wording import described, nearest

__all__ = ["load"]

_TOML_PLACE = re.compile(r"\s*\(at (?:line (\d+), column (\d+)|end of document)\)$")
_KEY_TUPLE = re.compile(r"\('([^)]*?)',?\)")
_MOST_PARTS = 64
_LONGEST_WORD = 10_000
_MOST_KEYS = 200_000  # 10,000 nodes have 120,000 at most
_NO_WORD = re.compile(  # comments, and texts, which may be a part of a key; an open one goes on to its end
    r"""\"{3}(?:[^\\]|\\.)*?(?:"{3,5}|\Z)|'{3}.*?(?:'{3,5}|\Z)|"(?:[^"\\\n]|\\[^\n])*"?|'[^'\n]*'?|\#[^\n]*""",
    re.DOTALL,
)
_WORD = re.compile(r"[\w\-. \t]+")
_UTF16_MARKS = (b"\xff\xfe", b"\xfe\xff")
_HINTS = {
    "Cannot overwrite a value": "a key is given twice; keep one",
    "Cannot declare": "a table is headed twice; lists of tables, such as [[nodes]], take double brackets",
    "Invalid value": "texts stand in quotes, lists in brackets, and numbers are written as in 8.0 or 1e-3",
    "Expected '=' after a key": "lines are written as in power_w = 1.0",
    "Invalid statement": "lines are written as in power_w = 1.0",
    "Expected newline": "every key stands on a line of its own",
}


def load(path: str | os.PathLike[str], *, allow_outside: bool = False) -> Scenario:
    """Returns the scenario that a TOML file describes, with the nodes of the file that it may name.

    Args:
        path: the file, of 10 MB at most.
        allow_outside: whether the file of nodes may be outside the folder of this one.

    Raises:
        ScenarioError: when the file cannot be read or is faulty; with every fault it has.
    """
    source = os.fspath(path)
    try:
        tables = _tables(_text(source))
    except _UnusableFileError as error:
        raise ScenarioError([error.fault], source) from None
    if "nodes_from" in tables:
        return _with_nodes_from(tables, source, allow_outside)
    return Scenario.from_dict(tables, source)


def scenario_from_text(content: bytes, name: str) -> Scenario:
    """Returns the scenario that the content of a file describes, which may name no other file.

    Args:
        content: the file's bytes, 10 MB at most.
        name: what to call the file in messages.

    Raises:
        ScenarioError: with every fault of the content.
    """
    try:
        if len(content) > MOST_BYTES:
            raise _UnusableFileError(f"it is larger than {MOST_BYTES / 1e6:g} MB, the most that is read")
        tables = _tables(_decoded(content))
        if "nodes_from" in tables:
            message = "only a file on this machine may name another; list the nodes here, under [[nodes]]"
            raise _UnusableFileError(message, "nodes_from")
    except _UnusableFileError as error:
        raise ScenarioError([error.fault], name) from None
    return Scenario.from_dict(tables, name)


def files_of(path: Path) -> dict[str, Path]:
    """Returns the files that a scenario is read from, by what to call them.

    Args:
        path: of a scenario file that loads.
    """
    nodes = _tables(_text(str(path))).get("nodes_from")
    return {"the scenario": path} | ({} if nodes is None else {"nodes_from": path.parent / nodes})


def inside(folder: Path, file: str, allow_outside: bool) -> Path:
    """Returns where a file is that another one names.

    Args:
        folder: of the file that names it.
        file: as it is named.
        allow_outside: whether it may be anywhere.

    Raises:
        _UnusableFileError: it is, through links or not, neither in that folder nor below it.
    """
    # A null character, which no path may hold, is told of when the file is read.
    real, root = os.path.realpath(folder / file.replace("\0", "")), os.path.realpath(folder)
    if not allow_outside and not Path(real).is_relative_to(root):
        raise _UnusableFileError(
            f"got {described(file)}, which is outside the folder of the file that names it; put it there, or "
            "allow this by --allow-outside (in Python allow_outside=True)"
        )
    return folder / file


def _with_nodes_from(tables: dict[str, Any], source: str, allow_outside: bool) -> Scenario:
    """Returns the scenario whose nodes another file lists; faults name the place in either file."""
    file = tables["nodes_from"]
    nodes, faults = None, []
    try:
        nodes = _nodes_from(file, Path(source).parent, tables, allow_outside)
        faults += [_in_file(file, fault) for fault in nodes.faults]
    except NodesFileError as error:
        faults += [_in_file(file, fault) for fault in error.faults]
    except _UnusableFileError as error:
        faults.append(_in_file(file, error.fault) if error.fault.path else Fault("nodes_from", str(error)))
    # The nodes take the place of the key, so that faults come in the order of the file.
    whole = {("nodes" if key == "nodes_from" else key): value for key, value in tables.items()}
    if nodes is not None:
        whole["nodes"] = nodes.members
    elif "nodes" not in tables:
        del whole["nodes"]
    try:
        scenario = Scenario.from_dict(whole, source)
    except ScenarioError as error:
        if nodes is not None:
            told = [nodes.retold(fault, file) for fault in error.faults]
        else:
            told = [fault for fault in error.faults if fault.path != "nodes" or "nodes" in tables]
        raise ScenarioError([*faults, *(fault for fault in told if fault is not None)], source) from None
    if faults:
        raise ScenarioError(faults, source)
    return scenario


def _nodes_from(file: object, folder: Path, tables: Mapping[str, object], allow_outside: bool) -> ListedNodes:
    if "nodes" in tables:
        raise _UnusableFileError("both nodes and nodes_from are given, exactly one is allowed; remove either")
    if not isinstance(file, str) or not file.strip():
        raise _UnusableFileError(
            f'got {described(file)}, must be the name of a GeoJSON or CSV file, as in "nodes.geojson"'
        )
    read, path = reader_of(file), inside(folder, file, allow_outside)
    return read(_text(str(path), _NODES_FILE, folder))


def _in_file(file: str, fault: Fault) -> Fault:
    return Fault(f"{file}: {fault.path}" if fault.path else file, fault.message)


@dataclass(frozen=True, slots=True)
class _Kind:
    """A kind of file: what it is called, what it is usually named, and how such names end."""

    noun: str
    usual_name: str
    endings: tuple[str, ...]


_SCENARIO_FILE = _Kind("a scenario file", "scenario.toml", (".toml",))
_NODES_FILE = _Kind("a file of nodes", "nodes.geojson", tuple(KINDS))


class _UnusableFileError(Exception):
    def __init__(self, message: str, place: str = "") -> None:
        self.fault = Fault(place, message)
        super().__init__(message)


def _text(path: str, kind: _Kind = _SCENARIO_FILE, base: Path = Path()) -> str:
    """Returns a file's text; other files are suggested as seen from the base."""
    try:
        content = read_bytes(Path(path))
    except FileNotFoundError:
        raise _UnusableFileError(f"there is no such file{_other_files(Path(path), kind, base)}") from None
    except IsADirectoryError:
        others = _other_files(Path(path) / kind.usual_name, kind, base)
        raise _UnusableFileError(f"this is a folder, must be {kind.noun}{others}") from None
    except OSError as error:
        reason = error.strerror or "unknown reason"
        raise _UnusableFileError(
            f"the file cannot be read ({reason[:1].lower()}{reason[1:]}); check its name and permissions"
        ) from None
    except ValueError:  # a null character in the name
        raise _UnusableFileError("this cannot be the name of a file") from None
    return _decoded(content)


def _decoded(content: bytes) -> str:
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        guess = " (it looks like UTF-16)" if content.startswith(_UTF16_MARKS) else ""
        line = content.count(b"\n", 0, error.start) + 1
        raise _UnusableFileError(
            f"byte 0x{content[error.start]:02x} is not UTF-8 text{guess}; save the file as UTF-8",
            f"line {line}",
        ) from None


def _other_files(path: Path, kind: _Kind, base: Path) -> str:
    """Returns what to try instead of a file that is not there."""
    folder = path.parent
    if not folder.is_dir():
        return f", nor a folder {folder}; check the path"
    try:
        names = sorted(entry.name for entry in folder.iterdir() if entry.suffix in kind.endings)
    except OSError:
        names = []
    guess = nearest(path.name, names) or (names[0] if len(names) == 1 else "")
    if not guess:
        return "; check the path"
    seen = folder / guess
    return f"; did you mean {seen.relative_to(base) if seen.is_relative_to(base) else seen}?"


def _tables(text: str) -> dict[str, Any]:
    if text.count("=") > _MOST_KEYS:  # each takes the reader some 5 microseconds
        raise _UnusableFileError(f"it has more than {_MOST_KEYS} keys, the most that is read")
    # Python's reader takes memory by the square of a key's parts, and much for a long number.
    if any(_is_monstrous(line) for line in text.split("\n")) and any(
        _is_monstrous(word) for word in _WORD.findall(_NO_WORD.sub("text", text))
    ):
        raise _UnusableFileError(
            f"a key has more than {_MOST_PARTS} parts, or a word more than {_LONGEST_WORD} characters"
        )
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise _broken_toml(str(error), text) from None
    except RecursionError:
        raise _UnusableFileError("lists or tables are nested too deeply to be read") from None
    except ValueError:  # an integer beyond what Python converts
        raise _UnusableFileError("a number has too many digits; write it as in 1e-3") from None


def _is_monstrous(text: str) -> bool:
    return len(text) > _LONGEST_WORD or text.count(".") > _MOST_PARTS


def _broken_toml(message: str, text: str) -> _UnusableFileError:
    found = _TOML_PLACE.search(message)
    lines = text.splitlines() or [""]
    if found and found[1]:
        line, column = int(found[1]), int(found[2])
    else:
        line, column = len(lines), len(lines[-1]) + 1
    words = _TOML_PLACE.sub("", message)
    words = _KEY_TUPLE.sub(lambda keys: keys[1].replace("', '", "."), words)
    hint = next((f" ({hint})" for start, hint in _HINTS.items() if words.startswith(start)), "")
    return _UnusableFileError(
        f"this is not TOML: {words[:1].lower()}{words[1:]}{hint}", f"line {line}, column {column}"
    )
