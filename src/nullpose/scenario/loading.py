"""From a file to a scenario."""

from __future__ import annotations

import os
import re
import tomllib
from pathlib import Path
from typing import Any

from nullpose.errors import Fault, ScenarioError
from nullpose.scenario.scenario import Scenario
from nullpose.scenario.wording import nearest

__all__ = ["load"]

_TOML_PLACE = re.compile(r"\s*\(at (?:line (\d+), column (\d+)|end of document)\)$")
_KEY_TUPLE = re.compile(r"\('([^)]*?)',?\)")
_UTF16_MARKS = (b"\xff\xfe", b"\xfe\xff")
_HINTS = {
    "Cannot overwrite a value": "a key is given twice; keep one",
    "Cannot declare": "a table is headed twice; lists of tables, such as [[nodes]], take double brackets",
    "Invalid value": "texts stand in quotes, lists in brackets, and numbers are written as in 8.0 or 1e-3",
    "Expected '=' after a key": "lines are written as in power_w = 1.0",
    "Invalid statement": "lines are written as in power_w = 1.0",
    "Expected newline": "every key stands on a line of its own",
}


def load(path: str | os.PathLike[str]) -> Scenario:
    """Returns the scenario that a TOML file describes.

    Args:
        path: the file.

    Raises:
        ScenarioError: when the file cannot be read or is faulty; with every fault it has.
    """
    source = os.fspath(path)
    try:
        return Scenario.from_dict(_tables(_text(source)), source)
    except _UnusableFileError as error:
        raise ScenarioError([error.fault], source) from None


class _UnusableFileError(Exception):
    def __init__(self, message: str, place: str = "") -> None:
        self.fault = Fault(place, message)
        super().__init__(message)


def _text(path: str) -> str:
    try:
        content = Path(path).read_bytes()
    except FileNotFoundError:
        raise _UnusableFileError(f"there is no such file{_other_files(Path(path))}") from None
    except IsADirectoryError:
        raise _UnusableFileError(
            f"this is a folder, must be a scenario file{_other_files(Path(path) / 'scenario.toml')}"
        ) from None
    except OSError as error:
        raise _UnusableFileError(
            f"the file cannot be read ({(error.strerror or 'unknown reason').lower()}); check its name and "
            "permissions"
        ) from None
    except ValueError:  # a null character in the name
        raise _UnusableFileError("this cannot be the name of a file") from None
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        guess = " (it looks like UTF-16)" if content.startswith(_UTF16_MARKS) else ""
        line = content.count(b"\n", 0, error.start) + 1
        raise _UnusableFileError(
            f"byte 0x{content[error.start]:02x} is not UTF-8 text{guess}; save the file as UTF-8",
            f"line {line}",
        ) from None


def _other_files(path: Path) -> str:
    """Returns what to try instead of a file that is not there."""
    folder = path.parent
    if not folder.is_dir():
        return f", nor a folder {folder}; check the path"
    try:
        names = sorted(entry.name for entry in folder.iterdir() if entry.suffix == ".toml")
    except OSError:
        names = []
    guess = nearest(path.name, names) or (names[0] if len(names) == 1 else "")
    return f"; did you mean {folder / guess}?" if guess else "; check the path"


def _tables(text: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise _broken_toml(str(error), text) from None
    except RecursionError:
        raise _UnusableFileError("lists or tables are nested too deeply to be read") from None
    except ValueError:  # an integer beyond what Python converts
        raise _UnusableFileError("a number has too many digits; write it as in 1e-3") from None


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
