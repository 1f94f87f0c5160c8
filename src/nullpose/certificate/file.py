"""Certificates as files: JSON, compressed if the name ends in ``.gz``."""

from __future__ import annotations

import gzip
import hashlib
import json
import math
import zlib
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nullpose.certificate.certificate import OFF_BAND, Certificate, Leaves, Tree
from nullpose.errors import CertificateError, ScenarioError
from nullpose.files import parse_json, read_bytes, replacing
from nullpose.objectives import USUAL
from nullpose.scenario import Scenario
from nullpose.scenario.wording import printable

__all__ = [
    "FORMAT",
    "VERSIONS",
    "certificate_text",
    "parse_certificate",
    "read_certificate",
    "write_certificate",
]

FORMAT = "nullpose-certificate"
VERSIONS = (1, 2)

_GZIP_MAGIC = b"\x1f\x8b"
_GZIP = 31  # for zlib: a header and a checksum as gzip writes them
_START = 4096  # bytes in which the format has to be named
_MOST_BYTES = 64_000_000  # three times what the most leaves that a proof keeps take
_COLUMNS = ("box", "cell", "test", "point", "level", "mix", "sides", "band", "ball", "ball_multiplier")
_LATER = {"band": 2}  # columns by the version that they came with
_SHAPES = {"box": 6, "cell": 5, "sides": 2}
_KEYS = (
    "format",
    "version",
    "scenario",
    "scenario_sha256",
    "scheme",
    "null_jammer",
    "value",
    "upper_bound",
    "pose",
    "trees",
    "provenance",
)
_POSE_KEYS = ("position_m", "roll_rad", "pitch_rad", "yaw_rad")
_TREE_KEYS = ("axis", "root_m", "leaves")
_KINDS: dict[type[Any], str] = {dict: "a table", list: "a list", str: "a text"}
_WHOLE = {"box", "cell", "test", "point", "mix", "ball"}


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
        text = _unpacked(read_bytes(path, _MOST_BYTES)).decode()
    except (UnicodeDecodeError, CertificateError, zlib.error) as error:
        raise CertificateError(f"{path}: is no certificate: {error}") from error
    except OSError as error:
        raise CertificateError(f"{path}: cannot be read: {error.strerror or error}") from error
    except ValueError as error:  # a null character in the name
        raise CertificateError(f"{path}: cannot be read: {error}") from error
    try:
        return parse_certificate(text)
    except CertificateError as error:
        raise CertificateError(f"{path}: {error}") from error
    except ScenarioError as error:
        raise ScenarioError(error.faults, f"{path}: {error.source}") from error


def _unpacked(data: bytes) -> bytes:
    """Return the bytes of a certificate, unpacked within bounds if they are compressed."""
    packed, stream = data.startswith(_GZIP_MAGIC), zlib.decompressobj(_GZIP)
    start = stream.decompress(data, _START) if packed else data[:_START]
    if FORMAT.encode() not in start:  # most of what grows a thousandfold ends here
        raise CertificateError(f"its first {_START} bytes do not name the format {FORMAT!r}")
    if packed:
        data = start + stream.decompress(stream.unconsumed_tail, _MOST_BYTES)
        if stream.unconsumed_tail:
            raise CertificateError(f"it grows beyond {_MOST_BYTES / 1e6:g} MB, the most that is read")
        if not stream.eof or stream.unused_data:
            raise CertificateError("it is cut off, or something follows it")
    return data


def scenario_digest(data: Mapping[str, Any]) -> str:
    """Return the SHA-256 of a scenario's plain data, in canonical JSON."""
    return hashlib.sha256(json.dumps(data, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


def certificate_text(certificate: Certificate) -> str:
    """Return a certificate as JSON, one line for each column, in the earliest version that can hold it.

    Args:
        certificate: what to write down.
    """
    scenario = certificate.scenario.to_dict()
    version = _version(certificate)
    data: dict[str, Any] = {
        "format": FORMAT,
        "version": version,
        "scenario": scenario,
        "scenario_sha256": scenario_digest(scenario),
        "scheme": certificate.scheme,
        "null_jammer": certificate.null_jammer,
        "value": certificate.value,
        "upper_bound": certificate.upper_bound,
        "pose": {
            "position_m": [float(x) for x in certificate.position_m],
            "roll_rad": certificate.roll_rad,
            "pitch_rad": certificate.pitch_rad,
            "yaw_rad": certificate.yaw_rad,
        },
        "trees": [_tree_data(tree, version) for tree in certificate.trees],
        "provenance": dict(certificate.provenance),
    }
    return _lines(data, 0) + "\n"


def _version(certificate: Certificate) -> int:
    """Return the version of the format that a certificate needs."""
    scenario, leaves = certificate.scenario, [tree.leaves for tree in certificate.trees]
    needs_second = (
        scenario.objective != USUAL
        or scenario.has_margins
        or scenario.airframe is not None
        or scenario.airspace.geofence_m is not None
        or bool(scenario.airspace.no_fly)
        or any(np.any(each.band != 0.0) or np.any(each.test == OFF_BAND) for each in leaves)
    )
    return 2 if needs_second else 1


def _columns(version: int) -> list[str]:
    return [name for name in _COLUMNS if _LATER.get(name, 1) <= version]


def _lines(value: Any, depth: int) -> str:
    """Return JSON with the outer tables spread over lines and the columns on one line each."""
    if depth > 4 or not isinstance(value, dict | list) or not value or (depth > 0 and not _nested(value)):
        return json.dumps(value, separators=(",", ":"), allow_nan=False)
    pad = " " * (depth + 1)
    if isinstance(value, dict):
        body = [f"{pad}{json.dumps(key)}: {_lines(item, depth + 1)}" for key, item in value.items()]
        return "{\n" + ",\n".join(body) + "\n" + " " * depth + "}"
    return "[\n" + ",\n".join(pad + _lines(item, depth + 1) for item in value) + "\n" + " " * depth + "]"


def _nested(value: Any) -> bool:
    items = value.values() if isinstance(value, dict) else value
    return any(isinstance(item, dict) for item in items) or (isinstance(value, dict) and "box" in value)


def _tree_data(tree: Tree, version: int) -> dict[str, Any]:
    leaves = tree.leaves
    columns: dict[str, Any] = {name: getattr(leaves, name).tolist() for name in _columns(version)}
    columns["mixes"] = [[[k, w] for k, w in mix.items()] for mix in leaves.mixes]
    return {"axis": tree.axis, "root_m": tree.root_m.tolist(), "leaves": columns}


def parse_certificate(text: str) -> Certificate:
    """Return the certificate in a text.

    Args:
        text: JSON as :func:`certificate_text` writes it.

    Raises:
        CertificateError: it is no certificate, or its scenario is not the one it was made for.
        ScenarioError: the scenario inside is faulty.
    """
    data = _plain(text)
    scenario = _get(data, "scenario", dict)
    if scenario_digest(scenario) != data.get("scenario_sha256"):
        raise CertificateError(
            "scenario_sha256: the scenario is not the one that the certificate was made for"
        )
    pose = _get(data, "pose", dict)
    null_jammer = data.get("null_jammer", 0)
    if not (null_jammer is None or isinstance(null_jammer, str)):
        raise CertificateError("null_jammer: is missing or wrong; must be a name or null")
    certificate = Certificate(
        scenario=Scenario.from_dict(scenario, "scenario"),
        scheme=_get(data, "scheme", str),
        null_jammer=null_jammer,
        value=_number(data, "value"),
        upper_bound=_number(data, "upper_bound"),
        position_m=_array(pose, "position_m", "pose.", (3,)),
        roll_rad=_number(pose, "roll_rad", "pose."),
        pitch_rad=_number(pose, "pitch_rad", "pose."),
        yaw_rad=_number(pose, "yaw_rad", "pose."),
        trees=tuple(
            _tree(tree, f"trees[{i}].", data["version"]) for i, tree in enumerate(_get(data, "trees", list))
        ),
        provenance=_get(data, "provenance", dict),
    )
    if _version(certificate) > data["version"]:
        raise CertificateError(f"version: what it holds came with version {_version(certificate)}")
    return certificate


def _plain(text: str) -> dict[str, Any]:
    """Return a certificate's tables, having asked for no more than its format and version."""
    try:
        data = parse_json(text, parse_constant=_no_number, parse_float=_finite)
    except ScenarioError as error:
        raise CertificateError(f"is no certificate: {error}") from error
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise CertificateError(f"is no certificate: its format must be {FORMAT!r}")
    version = data.get("version")
    if type(version) is not int or version not in VERSIONS:
        known = " and ".join(map(str, VERSIONS))
        raise CertificateError(f"version: this nullpose reads versions {known}, and no other")
    _refuse_unknown(data, "", _KEYS)
    _refuse_unknown(data.get("pose"), "pose.", _POSE_KEYS)
    for i, tree in enumerate(data["trees"] if isinstance(data.get("trees"), list) else ()):
        _refuse_unknown(tree, f"trees[{i}].", _TREE_KEYS)
        leaves = tree.get("leaves") if isinstance(tree, dict) else None
        _refuse_unknown(leaves, f"trees[{i}].leaves.", (*_columns(version), "mixes"))
    return data


def _refuse_unknown(table: object, path: str, known: Collection[str]) -> None:
    for key in table if isinstance(table, dict) else ():
        if key not in known:
            raise CertificateError(
                f"{path}{printable(key)}: unknown key; the keys here are {', '.join(known)}"
            )


def _no_number(name: str) -> None:
    raise ValueError(f"{name} is no number")


def _finite(digits: str) -> float:
    number = float(digits)
    if not math.isfinite(number):
        raise ValueError(f"{digits} is too large")
    return number


def _tree(data: Any, path: str, version: int) -> Tree:
    if not isinstance(data, dict):
        raise CertificateError(f"{path[:-1]}: must be a table")
    inside = path + "leaves."
    columns = _get(data, "leaves", dict, path)
    count = len(_get(columns, "test", list, inside))
    arrays = {
        name: _array(
            columns, name, inside, (count, _SHAPES[name]) if name in _SHAPES else (count,), name in _WHOLE
        )
        for name in _columns(version)
    }
    arrays |= {name: np.zeros(count) for name in _LATER if name not in arrays}
    mixes = tuple(
        _mix(mix, f"{inside}mixes[{i}]") for i, mix in enumerate(_get(columns, "mixes", list, inside))
    )
    root_m = _array(data, "root_m", path, (2, 3))
    return Tree(axis=_get(data, "axis", str, path), root_m=root_m, leaves=Leaves(mixes=mixes, **arrays))


def _mix(data: Any, path: str) -> dict[int, float]:
    pairs = data if isinstance(data, list) else [data]
    paired = all(isinstance(pair, list) and len(pair) == 2 and type(pair[0]) is int for pair in pairs)
    mix = {pair[0]: _float(pair[1]) for pair in pairs} if paired else {}
    if len(mix) != len(pairs) or any(k < 0 or not math.isfinite(w) for k, w in mix.items()):
        raise CertificateError(f"{path}: must be a list of [ratio, weight] with different ratios")
    return mix


def _get(data: Mapping[str, Any], key: str, kind: type[Any], path: str = "") -> Any:
    value = data.get(key)
    if not isinstance(value, kind):
        what = "is missing" if key not in data else "is wrong"
        raise CertificateError(f"{path}{key}: {what}; must be {_KINDS[kind]}")
    return value


def _float(value: Any) -> float:
    """Return a JSON number as a float; whatever is none, or is too large, as not-a-number."""
    if type(value) not in (int, float):
        return math.nan
    try:
        return float(value)
    except OverflowError:
        return math.nan


def _number(data: Mapping[str, Any], key: str, path: str = "") -> float:
    number = _float(data.get(key))
    if not math.isfinite(number):
        what = "is missing" if key not in data else "is wrong"
        raise CertificateError(f"{path}{key}: {what}; must be a finite number")
    return number


def _array(
    data: Mapping[str, Any], key: str, path: str, shape: tuple[int, ...], whole: bool = False
) -> NDArray[Any]:
    value = _get(data, key, list, path)
    rows = value if len(shape) == 2 else [value]
    if (len(shape) == 2 and len(rows) != shape[0]) or not all(
        isinstance(row, list) and len(row) == shape[-1] for row in rows
    ):
        words = " lists of ".join(str(n) for n in shape)
        raise CertificateError(f"{path}{key}: must be {words} numbers")
    kinds = {type(item) for row in rows for item in row}
    try:
        if kinds <= ({int} if whole else {int, float}):
            array = np.array(value, dtype=np.int64 if whole else float).reshape(shape)
            if np.all(np.isfinite(array)):
                return array
    except OverflowError:
        pass
    raise CertificateError(f"{path}{key}: must hold {'whole' if whole else 'finite'} numbers only")
