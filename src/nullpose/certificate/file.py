"""Certificates as files: JSON, compressed if the name ends in ``.gz``."""

from __future__ import annotations

import gzip
import hashlib
import json
import math
import zlib
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path
from types import UnionType
from typing import Any, TypeAlias

import numpy as np

from nullpose.certificate.certificate import COLUMNS, Certificate, Leaves, Tree
from nullpose.errors import CertificateError, ScenarioError, require
from nullpose.files import parse_json, read_bytes, replacing
from nullpose.scenario import Scenario
from nullpose.scenario.faults import printable

FORMAT = "nullpose-certificate"
VERSION, STILL_VERSION = 3, 2
"""The version written, and one that is read as well: it is of a scene that stands, and states no instants."""

_GZIP_MAGIC = b"\x1f\x8b"
_GZIP = 31  # for zlib: a header and a checksum as gzip writes them
_START = 4096  # bytes in which the format has to be named
_MOST_BYTES = 64_000_000  # three times what the most leaves that a proof keeps take
_DEEPEST = 4  # tables below stand on one line
_require = partial(require, CertificateError)


def write_certificate(certificate: Certificate, path: Path) -> None:
    """Write a certificate to a file.

    Args:
        certificate: what to write.
        path: where; compressed if it ends in ``.gz``.

    Raises:
        OutputError: the file cannot be written.
    """
    data = certificate_text(certificate).encode()
    with replacing(path) as temporary:
        temporary.write_bytes(gzip.compress(data, mtime=0) if path.suffix == ".gz" else data)


def read_certificate(path: Path) -> Certificate:
    """Return the certificate in a file.

    Args:
        path: the file, compressed or not, of 64 MB at most when it is not.

    Raises:
        CertificateError: it cannot be read, or is no certificate.
        ScenarioError: the scenario inside is faulty.
    """
    try:
        return parse_certificate(_unpacked(read_bytes(path, _MOST_BYTES)).decode())
    except ScenarioError as error:
        raise ScenarioError(error.faults, f"{path}: {error.source}") from error
    except CertificateError as error:
        raise CertificateError(f"{path}: {error}") from error
    except (UnicodeDecodeError, zlib.error) as error:
        raise CertificateError(f"{path}: is no certificate: {error}") from error
    except (OSError, ValueError) as error:  # the latter for a null character in the name
        raise CertificateError(
            f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}"
        ) from error


def _unpacked(data: bytes) -> bytes:
    """Return the bytes of a certificate, unpacked within bounds if they are compressed."""
    packed, stream = data.startswith(_GZIP_MAGIC), zlib.decompressobj(_GZIP)
    start = stream.decompress(data, _START) if packed else data[:_START]
    if FORMAT.encode() not in start:  # most of what grows a thousandfold ends here
        _require(
            b"[airspace]" not in start and b"[receiver]" not in start,
            "is a scenario, not a certificate; nullpose solve with --certificate FILE writes one",
        )
        raise CertificateError(
            f"is no certificate: its first {_START} bytes do not name the format {FORMAT!r}"
        )
    if packed:
        data = start + stream.decompress(stream.unconsumed_tail, _MOST_BYTES)
        _require(
            not stream.unconsumed_tail, f"it grows beyond {_MOST_BYTES / 1e6:g} MB, the most that is read"
        )
        _require(
            stream.eof and not stream.unused_data,
            "is no certificate: it is cut off, or something follows it",
        )
    return data


def scenario_digest(data: Mapping[str, object]) -> str:
    """Return the SHA-256 of a scenario's plain data, in canonical JSON."""
    return hashlib.sha256(json.dumps(data, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


def certificate_text(certificate: Certificate) -> str:
    """Return a certificate as JSON, one line for each column.

    Args:
        certificate: what to write down.
    """
    scenario = certificate.scenario.to_dict()
    data = {key: getattr(certificate, key, None) for key in _LAYOUT} | {
        "format": FORMAT,
        "version": VERSION,
        "scenario": scenario,
        "scenario_sha256": scenario_digest(scenario),
        "pose": {key: np.asarray(getattr(certificate, key)).tolist() for key in _POSE},
        "trees": [
            {
                "axis": tree.axis,
                "root_m": tree.root_m.tolist(),
                "leaves": {name: getattr(tree.leaves, name).tolist() for name in COLUMNS}
                | {"mixes": [list(mix.items()) for mix in tree.leaves.mixes]},
            }
            for tree in certificate.trees
        ],
        "instants": list(certificate.instants),
        "provenance": dict(certificate.provenance),
    }
    return _lines(data, 0) + "\n"


def _lines(value: Any, depth: int) -> str:
    """Return JSON with the outer tables spread over lines and everything else on one line each."""
    is_table, is_list = isinstance(value, dict), isinstance(value, list)
    if not value or depth > _DEEPEST or not (is_table or (is_list and isinstance(value[0], dict))):
        return json.dumps(value, separators=(",", ":"), allow_nan=False)
    items = [(f"{json.dumps(key)}: ", value[key]) for key in value] if is_table else [("", x) for x in value]
    parts = [key + _lines(item, depth + 1) for key, item in items]
    brackets, pad = "{}" if is_table else "[]", "\n" + " " * depth
    return brackets[0] + pad + " " + f",{pad} ".join(parts) + pad + brackets[1]


def parse_certificate(text: str) -> Certificate:
    """Return the certificate in a text.

    Args:
        text: JSON as :func:`certificate_text` writes it.

    Raises:
        CertificateError: it is no certificate, or its scenario is not the one it was made for.
        ScenarioError: the scenario inside is faulty.
    """
    try:
        data = parse_json(text, parse_constant=_finite, parse_float=_finite)
    except ScenarioError as error:
        raise CertificateError(f"is no certificate: {error}") from error
    _require(
        isinstance(data, dict) and data.get("format") == FORMAT,
        f"is no certificate: its format must be {FORMAT!r}",
    )
    _require(
        type(data.get("version")) is int and data["version"] in (STILL_VERSION, VERSION),
        f"version: must be {STILL_VERSION} or {VERSION}; solve again with --certificate to have one",
    )
    if data["version"] == STILL_VERSION:
        _require("instants" not in data, f"instants: only version {VERSION} states them")
        data = {"instants": [], **data}
    scenario = _table(data.get("scenario", _MISSING), "scenario")
    _require(
        scenario_digest(scenario) == data.get("scenario_sha256"),
        "scenario_sha256: the scenario is not the one that the certificate was made for",
    )
    data = _read(data, "", _LAYOUT)
    return Certificate(
        scenario=Scenario.from_dict(scenario, "scenario"),
        trees=tuple(
            Tree(axis=tree["axis"], root_m=tree["root_m"], leaves=Leaves(**tree["leaves"]))
            for tree in data["trees"]
        ),
        instants=tuple(data["instants"].tolist()),
        **{key: data[key] for key in ("scheme", "null_jammer", "value", "upper_bound", "provenance")},
        **data["pose"],
    )


def _finite(digits: str) -> float:
    if not math.isfinite(number := float(digits)):
        raise ValueError(f"{digits} is no number, or too large")
    return number


# Returns what a plain value stands for, given its path for the message if it is wrong.
Reader: TypeAlias = Callable[[object, str], Any]


_MISSING = object()


def _refusal(value: object, path: str, words: str) -> str:
    return f"{path}: {'is missing' if value is _MISSING else 'is wrong'}; must be {words}"


def _plain(value: object, path: str, kinds: type | UnionType, words: str) -> Any:
    """Return a value that is as it should be if it is of some kind."""
    _require(isinstance(value, kinds), _refusal(value, path, words))
    return value


_table = partial(_plain, kinds=dict, words="a table")
_list = partial(_plain, kinds=list, words="a list")


def _numbers(value: Any, path: str, shape: tuple[int, ...] = (), kind: type = float) -> Any:
    """Return numbers as an array of a shape, in which -1 stands for any length; without one, as a number."""
    flat, fits = [value], True
    for n in shape:
        fits = fits and all(isinstance(row, list) and n in (-1, len(row)) for row in flat)
        flat = [item for row in flat for item in row] if fits else []
    if fits and {type(item) for item in flat} <= {int, kind}:
        with suppress(OverflowError):
            if np.all(np.isfinite(array := np.array(flat, dtype=np.int64 if kind is int else float))):
                return array.reshape(shape) if shape else array.item()
    sizes = "".join("a list, each " if n < 0 else f"a list of {n}, each " for n in shape)
    raise CertificateError(_refusal(value, path, f"{sizes}a {'whole' if kind is int else 'finite'} number"))


def _list_of(read: Reader) -> Reader:
    """Return the reader of lists of which another reads the items."""
    return lambda value, path: tuple(read(x, f"{path}[{i}]") for i, x in enumerate(_list(value, path)))


def _mixes(value: Any, path: str) -> tuple[dict[int, float], ...]:
    """Return mappings from ratio to weight; there may be very many, so that they are looked at together."""
    pairs = [pair for mix in _list(value, path) for pair in (mix if isinstance(mix, list) else [mix])]
    _numbers(pairs, path, (-1, 2))
    mixes = tuple(dict(mix) for mix in value)
    of_ratios = all(type(ratio) is int and ratio >= 0 for mix in mixes for ratio in mix)
    is_right = of_ratios and sum(map(len, mixes)) == len(pairs)
    _require(is_right, _refusal(value, path, "lists of [ratio, weight] with different ratios"))
    return mixes


def _leaves(value: object, path: str) -> dict[str, Any]:
    """Return columns of equal length."""
    columns = _read(value, path, _LEAVES)
    for name in COLUMNS:
        _require(
            len(columns[name]) == len(columns["test"]),
            f"{path}.{name}: must have an entry for each of {len(columns['test'])} tests",
        )
    return columns


def _read(value: object, path: str, layout: Mapping[str, Reader]) -> dict[str, Any]:
    """Return a table, each of whose keys is in the layout and the other way round."""
    place = f"{path}." if path else ""
    table = _table(value, path)
    for key in table:
        _require(
            key in layout, f"{place}{printable(key)}: unknown key; the keys here are {', '.join(layout)}"
        )
    return {key: read(table.get(key, _MISSING), place + key) for key, read in layout.items()}


_text = partial(_plain, kinds=str, words="a text")
_POSE: dict[str, Reader] = {
    "position_m": partial(_numbers, shape=(3,)),
    "roll_rad": _numbers,
    "pitch_rad": _numbers,
    "yaw_rad": _numbers,
}
_LEAVES: dict[str, Reader] = {
    name: partial(_numbers, shape=(-1, *shape), kind=kind) for name, (kind, shape) in COLUMNS.items()
} | {"mixes": _mixes}
_TREE: dict[str, Reader] = {"axis": _text, "root_m": partial(_numbers, shape=(2, 3)), "leaves": _leaves}
_LAYOUT: dict[str, Reader] = {
    "format": _text,
    "version": partial(_numbers, kind=int),
    "scenario": _table,
    "scenario_sha256": _text,
    "scheme": _text,
    "null_jammer": partial(_plain, kinds=str | None, words="a name or null"),
    "value": _numbers,
    "upper_bound": _numbers,
    "pose": partial(_read, layout=_POSE),
    "instants": partial(_numbers, shape=(-1,), kind=int),
    "trees": _list_of(partial(_read, layout=_TREE)),
    "provenance": _table,
}
