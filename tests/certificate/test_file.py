"""Certificates as files: what is written is read back, and whatever is none is refused in words."""

import gzip
import json
import subprocess
import sys
from collections.abc import Callable
from functools import reduce
from itertools import chain
from operator import getitem
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st
from sizes import few_examples
from tests.certificate.plain import certified

from nullpose.certificate import (
    Certificate,
    certificate_text,
    parse_certificate,
    read_certificate,
    write_certificate,
)
from nullpose.certificate.file import FORMAT, VERSION, scenario_digest
from nullpose.errors import CertificateError, OutputError, ScenarioError

Data = dict[str, Any]


@pytest.fixture(scope="module")
def certificate(paper: Callable) -> Certificate:
    """Returns a small certificate."""
    return certified(paper(keep_out_m=26.5), gap=0.1)


@pytest.fixture(scope="module")
def text(certificate: Certificate) -> str:
    """Returns it as text."""
    return certificate_text(certificate)


@pytest.fixture
def data(text: str) -> Data:
    """Returns it as plain data, to be spoiled."""
    return json.loads(text)


def fault(data: object) -> str:
    """Return the words with which data is refused."""
    with pytest.raises((CertificateError, ScenarioError)) as caught:
        parse_certificate(json.dumps(data))
    return str(caught.value)


@pytest.mark.parametrize("name", ["walled", "celled"])
def test_text_survives(name: str, request: pytest.FixtureRequest) -> None:
    """Text to certificate to text is the identity, cells, balls and mixes included."""
    text = certificate_text(request.getfixturevalue(name))
    assert certificate_text(parse_certificate(text)) == text
    json.loads(text, parse_constant=lambda name: pytest.fail(name))


@pytest.mark.parametrize("name", ["proof.json", "proof.json.gz"])
def test_files_survive(name: str, certificate: Certificate, tmp_path: Path) -> None:
    """Written and read, compressed or not, the certificate is the same, and so are its bytes."""
    path = tmp_path / name
    write_certificate(certificate, path)
    first = path.read_bytes()
    again = read_certificate(path)
    assert certificate_text(again) == certificate_text(certificate)
    write_certificate(again, path)
    assert path.read_bytes() == first
    assert first.startswith(b"\x1f\x8b") == (name[-2:] == "gz")
    renamed = tmp_path / "other"
    renamed.write_bytes(first)
    assert certificate_text(read_certificate(renamed)) == certificate_text(certificate)


def places(value: Any, path: tuple = ()) -> list[tuple]:
    """Return the paths of a certificate's parts; of long lists, of a few items only."""
    items = value.items() if isinstance(value, dict) else ()
    items = list(enumerate(value))[:2] if isinstance(value, list) else items
    inner = [places(item, (*path, key)) for key, item in items if key not in ("scenario", "provenance")]
    return [*([path] if path else []), *chain(*inner)]


def part_at(data: Any, path: tuple) -> Any:
    """Return the part that a path points to."""
    return reduce(getitem, path, data)


def words_for(path: tuple) -> str:
    """Return the name that a path's fault must carry: its last key that is no index."""
    return next(str(key) for key in reversed(path) if isinstance(key, str))


def test_missing_keys_are_named(data: Data) -> None:
    """Each key that is left out is asked for by its name."""
    for path in places(data):
        if isinstance(path[-1], str) and path != ("format",):
            broken = json.loads(json.dumps(data))
            del part_at(broken, path[:-1])[path[-1]]
            assert words_for(path) in fault(broken)
    data["version"] = 1
    assert fault(data) == f"version: must be 2 or {VERSION}; solve again with --certificate to have one"


def test_files_of_the_version_before_are_read(data: Data, text: str) -> None:
    """They say the same without instants, and are refused with them."""
    data["version"] = 2
    assert fault(data) == f"instants: only version {VERSION} states them"
    assert data.pop("instants") == []
    assert certificate_text(parse_certificate(json.dumps(data))) == certificate_text(parse_certificate(text))


def refusal(text: str) -> str:
    """Return the words with which a text is refused, none if it is not."""
    try:
        parse_certificate(text)
    except CertificateError as error:
        return str(error)
    return ""


WRONG = [None, True, False, "1", "", {}, {"a": 1}, [], [[]], [None], [[[1]]], 1, 10**400, 1.5, -1.5, "NaN"]


def test_wrong_types_are_named(data: Data) -> None:
    """Any value put anywhere is either as good or refused by name; nothing else is raised."""
    refused = 0
    for path in places(data):
        for wrong in WRONG:
            broken = json.loads(json.dumps(data))
            part_at(broken, path[:-1])[path[-1]] = wrong
            words = refusal(json.dumps(broken))
            # a column of another length is told of the first one that differs from it
            assert not words or words_for(path) in words or "trees[0].leaves." in words
            refused += bool(words)
    assert refused > 300


LEAVES = ("trees", 0, "leaves")


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("version",), float(VERSION)),
        (("pose", "position_m"), [1.0, 2.0]),
        (("pose", "position_m"), [1.0, 2.0, True]),
        (("trees", 0, "root_m"), [0.0] * 6),
        ((*LEAVES, "test", 0), 2**63),
        ((*LEAVES, "box", 0), [0, 0, 0, 0, 0]),
        ((*LEAVES, "box", 0, 0), 0.5),
        ((*LEAVES, "mixes"), [{"0": 1.0}]),
        ((*LEAVES, "mixes"), ["01"]),
        ((*LEAVES, "mixes", 0), [[0, 0.5], [0, 0.5]]),
        ((*LEAVES, "mixes", 0), [[-1, 0.5]]),
        ((*LEAVES, "mixes", 0), [[0, True]]),
        ((*LEAVES, "mixes", 0), [[True, 1.0]]),
        ((*LEAVES, "mixes", 0), [[0.0, 1.0]]),
    ],
)
def test_what_looks_like_a_number_is_refused(path: tuple, value: object, data: Data) -> None:
    """Booleans, texts, floats for whole numbers, wrong shapes and too large numbers are named."""
    part_at(data, path[:-1])[path[-1]] = value
    assert words_for(path) in fault(data)


@pytest.mark.parametrize("number", ["NaN", "Infinity", "-Infinity", "1e999", "-1e999"])
def test_numbers_that_are_none_are_refused(number: str, data: Data) -> None:
    """What JSON lacks, and what no float holds, is refused wherever it stands."""
    for path in (("value",), ("trees", 0, "leaves", "level", 0), ("provenance", "x"), ("scenario", "name")):
        broken = json.loads(json.dumps(data))
        part_at(broken, path[:-1])[path[-1]] = "@"
        with pytest.raises(CertificateError, match="no certificate"):
            parse_certificate(json.dumps(broken).replace('"@"', number))


def test_a_changed_scenario_is_found(data: Data, tmp_path: Path) -> None:
    """A scenario that its digest does not fit is refused; with another digest its own faults are told."""
    data["scenario"]["jammers"][0]["power_w"] = 1.0000001
    assert "scenario_sha256" in fault(data)
    path = tmp_path / "proof.json"
    for key, value in (("power_w", -1.0), ("power_w", True), ("position_m", "here"), ("name", "\ud800")):
        broken = json.loads(json.dumps(data))
        broken["scenario"]["jammers"][0][key] = value
        broken["scenario_sha256"] = scenario_digest(broken["scenario"])
        path.write_text(json.dumps(broken), encoding="utf-8")
        with pytest.raises(ScenarioError) as caught:
            read_certificate(path)
        assert str(caught.value).startswith(f"{path}: scenario: ")
        assert [found.path for found in caught.value.faults] == [f"jammers[0].{key}"]


FORMATTED = '{"format": "nullpose-certificate", "version": 1, "scenario": '
FOREIGN = [
    "",
    "null",
    "[]",
    '"nullpose-certificate"',
    '{"format": "nullpose-certificate"}',
    '{"format": ["nullpose-certificate"]}',
    "{",
    '{"a":' * 100_000,
    "1" * 10_000,
    "\ufeff{}",
    "\x00",
    FORMATTED + "[" * 900 + "]" * 900 + "}",
    FORMATTED + '{"a":' + "[" * 900 + "]" * 900 + "}}",
]


@pytest.mark.parametrize("content", FOREIGN, ids=range(len(FOREIGN)))
def test_foreign_texts_are_refused(content: str, tmp_path: Path) -> None:
    """Empty, foreign and broken JSON is refused, the file being named."""
    path = tmp_path / "proof.json"
    path.write_text(content, encoding="utf-8")
    with pytest.raises(CertificateError) as caught:
        read_certificate(path)
    assert str(caught.value).startswith(f"{path}: ")


def test_broken_files_are_refused(text: str, tmp_path: Path) -> None:
    """Cut or spoiled archives, binaries, folders and files that are not there are refused by name."""
    packed = gzip.compress(text.encode(), mtime=0)
    spoiled = bytearray(packed)
    spoiled[len(spoiled) // 2] ^= 0xFF
    path = tmp_path / "proof.json.gz"
    for content in (
        packed[:11],
        packed[: len(packed) // 2],
        packed[:-1],
        bytes(spoiled),
        packed + b"\x1f\x8b",
        packed[:3] + b"\xff" + packed[4:],
        gzip.compress(b""),
        gzip.compress(b"\xff\xfe"),
        bytes(range(256)),
        text.encode("utf-16"),
        text.encode()[: len(text) // 2],
    ):
        path.write_bytes(content)
        with pytest.raises(CertificateError) as caught:
            read_certificate(path)
        assert str(caught.value).startswith(f"{path}: ")
    for unreadable in (tmp_path, tmp_path / "missing.json", tmp_path / "a\0b"):
        with pytest.raises(CertificateError, match="cannot be read"):
            read_certificate(unreadable)


@few_examples(20)
@given(seed=st.integers(0, 2**32 - 1))
def test_any_flipped_byte_is_a_certificate_or_refused(
    seed: int, text: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """Random damage of the text, compressed or not, never ends in any other exception."""
    rng = np.random.default_rng(seed)
    path = tmp_path_factory.getbasetemp() / f"flipped-{seed}"
    content = bytearray(gzip.compress(text.encode(), mtime=0) if seed % 2 else text.encode())
    for at in rng.integers(len(content), size=int(rng.integers(1, 4))):
        content[at] = int(rng.integers(256))
    path.write_bytes(bytes(content))
    words = str(path)
    try:
        read_certificate(path)
    except (CertificateError, ScenarioError) as error:
        words = str(error)
    path.unlink()
    assert words.startswith(str(path))


def test_a_file_that_cannot_be_written_is_told(certificate: Certificate, tmp_path: Path) -> None:
    """A folder in the way, or none to write to, is an OutputError."""
    for path in (tmp_path, tmp_path / "missing" / "proof.json"):
        with pytest.raises(OutputError, match="cannot write"):
            write_certificate(certificate, path)


@pytest.mark.parametrize(
    ("path", "dotted"),
    [((), ""), (("pose",), "pose."), (("trees", 0), "trees[0]."), (LEAVES, "trees[0].leaves.")],
)
def test_unknown_keys_are_refused_by_path(path: tuple, dotted: str, data: Data) -> None:
    """A key that no version has is no part of a certificate; of what made it anything may be told."""
    data["provenance"]["anything"] = {"may": ["be", "here"]}
    assert refusal(json.dumps(data)) == ""
    part_at(data, path)["extra"] = 1
    assert fault(data).startswith(f"{dotted}extra: unknown key; the keys here are ")


@pytest.mark.parametrize("key", ["scheme", "roll_rad", "axis", "test", "power_w", "altitude_m"])
def test_keys_given_twice_are_refused(key: str, text: str) -> None:
    """Of two values for one thing neither counts."""
    at = text.index(f'"{key}":')
    words = refusal(f'{text[:at]}"{key}": 0, {text[at:]}')
    assert words.startswith("is no certificate: line ")
    assert words.endswith(f'the key "{key}" is given twice in one object; keep one')


@pytest.mark.parametrize(
    ("start", "words"), [("", "do not name the format"), (f'{{"format": "{FORMAT}', "grows beyond")]
)
def test_archives_that_grow_are_refused(start: str, words: str, tmp_path: Path) -> None:
    """A small file that would unpack to very much is refused by its start, or at the limit."""
    path = tmp_path / "proof.json.gz"
    with gzip.open(path, "wb") as file:
        file.write(start.encode())
        for _ in range(7):
            file.write(b" " * 10_000_000)
    assert path.stat().st_size < 100_000
    with pytest.raises(CertificateError, match=words):
        read_certificate(path)


def test_a_full_disk_leaves_the_old_certificate(certificate: Certificate, tmp_path: Path) -> None:
    """Half a proof never takes the place of a whole one."""
    path = tmp_path / "proof.json"
    write_certificate(certificate, path)
    before = path.read_bytes()
    code = (
        "import resource, signal, sys; from pathlib import Path\n"
        "from nullpose.certificate import read_certificate, write_certificate\n"
        "path = Path(sys.argv[1]); certificate = read_certificate(path)\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (999, 999))\n"
        "write_certificate(certificate, path)"
    )
    done = subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True, check=False)
    assert f"OutputError: cannot write {path}: File too large" in done.stderr
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]
