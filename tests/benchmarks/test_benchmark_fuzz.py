"""Damaged and hostile files: a hundred like those of ``benchmarks.fuzz``, and the worst that are known."""

import gzip
import os
from collections.abc import Callable
from pathlib import Path

import pytest
from benchmarks.fuzz.__main__ import main
from benchmarks.fuzz.check import check_file, damaged, in_a_process, in_this_process
from benchmarks.fuzz.targets import Target, targets
from hypothesis import given, settings, strategies as st

SCENE = b"[airspace]\naltitude_m = [8, 30]\n[receiver]\nnoise_w = 1e-3\nreference_gain_db = 0.0\n"
PROOF = b'{"format": "nullpose-certificate", "x": '
FEATURES = b'{"type": "FeatureCollection", "features": ['


@pytest.fixture(scope="module")
def kinds(tmp_path_factory: pytest.TempPathFactory) -> tuple[Target, ...]:
    """The kinds of files, each tried once as it is: what is imported late is imported then."""
    found = targets(tmp_path_factory.mktemp("targets"))
    for target in found:
        check_file(Target(target.kind, target.name, b"", target.arguments, target.beside), 0)
    return found


@settings(max_examples=100)
@given(number=st.integers(0, 10**9), place=st.integers(0, 10**3))
def test_damaged_files_are_read_or_refused_in_words(
    number: int, place: int, kinds: tuple[Target, ...]
) -> None:
    """Exit code 0 or 2, no traceback, a message of sensible length, in less than two seconds."""
    outcome = check_file(kinds[place % len(kinds)], number)
    assert outcome.faults == ()


def test_sound_files_are_read(kinds: tuple[Target, ...], tmp_path: Path) -> None:
    """Undamaged, every file is accepted, so that it is the damage that is refused."""
    for place, target in enumerate(kinds):
        folder = tmp_path / str(place)
        folder.mkdir()
        code, _, _, output = in_this_process(target.written(folder, target.content))
        if target.kind == "study spec":  # judged whole, and then there is no folder for its results
            assert "a file of that name is in the way" in output
        else:
            assert (code, target.kind) == (0, target.kind), output


def test_a_number_always_does_the_same_damage(kinds: tuple[Target, ...]) -> None:
    """What was found can be found again."""
    assert damaged(kinds[0], 7) == damaged(kinds[0], 7)
    assert len({damaged(kinds[0], number) for number in range(50)}) > 45


def test_the_command_tells_what_it_tried(capsys: pytest.CaptureFixture[str]) -> None:
    """A table by kind of file, and exit code 0 if all were refused as they should be."""
    assert main(["--files", "25", "--fresh", "9"]) == 0
    assert "| all | 25 |" in capsys.readouterr().out


def bomb(start: bytes, more: bytes, times: int) -> bytes:
    """Return a small archive of much."""
    return gzip.compress(start + more * times, 9)


def features(count: int) -> bytes:
    """Return GeoJSON with very many empty features."""
    return FEATURES + b"[]," * count + b"[]]}"


HOSTILE: dict[str, tuple[str, Callable[[], bytes]]] = {
    "300,000 unknown keys": ("s.toml", lambda: b"".join(b"k%d=1\n" % i for i in range(300_000)) + SCENE),
    "400,000 numbers for nodes": ("s.toml", lambda: b"nodes = [" + b"1," * 400_000 + b"]\n" + SCENE),
    "a key of 100,000 parts": ("s.toml", lambda: b".".join([b"a"] * 100_000) + b" = 1\n"),
    "100,000 lists": ("s.toml", lambda: b"x = " + b"[" * 100_000),
    "100,000 tables": ("s.toml", lambda: b"x = " + b"{ a = " * 100_000),
    "a number of 5 MB": ("s.toml", lambda: b"x = " + b"9" * 5_000_000),
    "a polygon of 9,000 corners": (
        "s.toml",
        lambda: SCENE.replace(b"\n[r", b"\ngeofence_m = [" + b"[1, 2]," * 9000 + b"]\n[r"),
    ),
    "null characters": ("s.toml", lambda: b'name = "\0"\n' + SCENE),
    "no UTF-8": ("s.toml", lambda: b"\xe9" * 5_000_000),
    "11 MB": ("s.toml", lambda: b"# " + b"x" * 11_000_000),
    "2,000,000 lines": ("n.csv", lambda: b"x_m,y_m,z_m,power_w\n" + b"1\n" * 2_000_000),
    "100,000 lists in GeoJSON": ("n.json", lambda: FEATURES + b"[" * 100_000),
    "3,000,000 features": ("n.json", lambda: features(3_000_000)),
    "1,400,000 features": ("n.json", lambda: features(1_400_000)),
    "a growing archive": ("p.json.gz", lambda: bomb(b"", b"\0" * 10_000_000, 20)),
    "a growing certificate": ("p.json.gz", lambda: bomb(PROOF + b'"', b"x" * 1_000_000, 150)),
    "a certificate of lists": ("p.json.gz", lambda: bomb(PROOF + b"[", b"[]," * 1000, 15_000)),
    "a certificate of fewer lists": ("p.json.gz", lambda: bomb(PROOF + b"[", b"[]," * 1000, 1400)),
    "a deep certificate": ("p.json", lambda: PROOF + b"[" * 100_000),
    "a certificate of digits": ("p.json", lambda: PROOF + b"9" * 5_000_000),
}


@pytest.mark.parametrize("what", HOSTILE)
def test_hostile_files_are_refused_at_once(what: str, tmp_path: Path) -> None:
    """In few seconds, start of the process and all, and in less than 200 MB."""
    name, content = HOSTILE[what]
    (tmp_path / "s.toml").write_bytes(f'nodes_from = "{name}"\n'.encode() + SCENE)
    (tmp_path / name).write_bytes(content())
    verb, file = ("verify", name) if name.startswith("p.") else ("check", "s.toml")
    code, seconds, megabytes, output = in_a_process((verb, str(tmp_path / file)))
    assert (code, output.splitlines()[0].startswith("error: ")) == (2, True)
    assert "Traceback" not in output
    assert len(output) < 10_000
    assert seconds < 8.0  # on any machine; about two on a quiet one, most of it Python's reader of TOML
    assert megabytes < 200.0


@pytest.mark.parametrize("verb", ["check", "verify", "study"])
def test_what_never_ends_is_not_read(verb: str, tmp_path: Path) -> None:
    """A pipe that nobody writes, and a device, in the place of any input."""
    os.mkfifo(tmp_path / "pipe")
    os.mkfifo(tmp_path / "pipe.csv")
    (tmp_path / "named.toml").write_bytes(b'nodes_from = "pipe.csv"\n' + SCENE)
    command = ("study", "run", "--out", str(tmp_path / "out")) if verb == "study" else (verb,)
    for file in ("/dev/zero", tmp_path / "pipe", *([tmp_path / "named.toml"] if verb == "check" else [])):
        code, seconds, _, output = in_a_process((*command, str(file)))
        assert code == 2
        assert "a device or a pipe" in output
        assert seconds < 8.0
