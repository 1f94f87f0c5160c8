"""Damaged and hostile files: read, or refused in words with exit code 2, at once and without a traceback."""

import gzip
import json
import os
import random
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given, strategies as st
from typer.testing import CliRunner

from nullpose import certificate_of, load, solve
from nullpose.certificate import certificate_text
from nullpose.cli.app import app
from scenes import EXAMPLES

SCENE = b"[airspace]\naltitude_m = [8, 30]\n[receiver]\nnoise_w = 1e-3\nreference_gain_db = 0.0\n"
ORIGIN = b"[origin]\nlat_deg = 50.0\nlon_deg = 14.5\nalt_m = 230.0\n"
CSV = b"name,x_m,y_m,z_m,power_dbm,weight\na,1.0,2.0,3.0,20,\nb,-40,20.5,0,17,2\nc,10,-30,1,20,\n"
PROOF = b'{"format": "nullpose-certificate", "x": '
WORD = re.compile(rb"[\w.+-]+|\"[^\"\n]*\"")
VALUES = (
    *(b"0", b"-1", b"1e308", b"1e-320", b"1e999", b"nan", b"-Infinity", b"9223372036854775808", b"9" * 5000),
    *(b"true", b"null", b"2020-01-01", b'""', b'"text"', b'"\\u0000"', b'"' + b"x" * 20_000 + b'"', b"[]"),
    *(b"{}", b"[1, 2]", b'{"a": 1}', b"[" * 100_000, b"\x00", b"\xff\xfe", b'"/etc/passwd"', b'"../x.csv"'),
)


def damaged(content: bytes, number: int) -> bytes:
    """Flip bytes, cut, repeat lines or put other values in the place of words, one to four times."""
    rng = random.Random(number)
    for _ in range(rng.randint(1, 4)):
        place = rng.randint(0, len(content))
        kind = rng.randrange(6)
        if kind == 0:
            content = content[:place] + bytes([rng.randrange(256)]) + content[place + 1 :]
        elif kind == 1:
            content = content[:place] + content[place + rng.randint(1, 200) :]
        elif kind == 2:
            content = content[:place] + content[place : place + 12] * rng.choice([2, 5000]) + content[place:]
        else:
            words = list(WORD.finditer(content))
            word = rng.choice(words) if words else None
            at = word.span() if word else (0, 0)
            content = content[: at[0]] + rng.choice(VALUES) + content[at[1] :]
    return content


@pytest.fixture(scope="module")
def sound_files() -> dict[str, tuple[str, bytes]]:
    """A verb and the content of a sound file of each kind; a scenario that names it stands beside it."""
    proof = certificate_text(certificate_of(solve(load(EXAMPLES / "paper.toml"), gap=0.1))).encode()
    scenarios = (path for path in EXAMPLES.glob("*.toml") if not path.stem.startswith("study"))
    files = {path.name: ("check", path.read_bytes()) for path in scenarios}
    return files | {
        "n.csv": ("check", CSV),
        "n.json": ("check", (EXAMPLES / "nodes.geojson").read_bytes()),
        "p.json": ("verify", proof),
        "p.json.gz": ("verify", gzip.compress(proof, mtime=0)),
    }


def run(folder: Path, name: str, verb: str, content: bytes) -> tuple[int, str]:
    """Write the file, and what goes with it, and give it to the command in this process."""
    for beside in ("nodes.geojson", "hexarotor-433mhz.out.gz"):
        (folder / beside).write_bytes((EXAMPLES / beside).read_bytes())
    (folder / name).write_bytes(content)
    if name.startswith("n."):
        origin = ORIGIN if name == "n.json" else b""
        (folder / "s.toml").write_bytes(f'nodes_from = "{name}"\n'.encode() + origin + SCENE)
        name = "s.toml"
    result = CliRunner().invoke(app, [verb, str(folder / name)])
    assert result.exception is None or isinstance(result.exception, SystemExit), repr(result.exception)
    return result.exit_code, result.output


@given(number=st.integers(0, 10**9), place=st.integers(0, 10**3))
def test_damaged_files_are_read_or_refused_in_words(number: int, place: int, sound_files: dict) -> None:
    """Exit code 0 or 2, 1 for a certificate that is rejected; a message of sensible length."""
    name = list(sound_files)[place % len(sound_files)]
    verb, content = sound_files[name]
    with TemporaryDirectory() as folder:
        code, output = run(Path(folder), name, verb, damaged(content, number))
    assert code in (0, 1, 2) if verb == "verify" and "rejected" in output else code in (0, 2)
    assert code != 2 or len(output) < 20_000


def test_sound_files_are_read(sound_files: dict, tmp_path: Path) -> None:
    """Undamaged, every file is accepted, so that it is the damage that is refused."""
    for name, (verb, content) in sound_files.items():
        assert (run(tmp_path, name, verb, content)[0], name) == (0, name)


def bomb(start: bytes, more: bytes, times: int) -> bytes:
    """Pack much into little."""
    return gzip.compress(start + more * times, 9)


HOSTILE: dict[str, tuple[str, Callable[[], bytes]]] = {
    "100,000 lists": ("s.toml", lambda: b"x = " + b"[" * 100_000),
    "null characters": ("s.toml", lambda: b'name = "\0"\n' + SCENE),
    "no UTF-8": ("s.toml", lambda: b"\xe9" * 5_000_000),
    "11 MB": ("s.toml", lambda: b"# " + b"x" * 11_000_000),
    "100,000 lists in GeoJSON": ("n.json", lambda: b'{"type": "x", "features": ' + b"[" * 100_000),
    "a growing archive": ("p.json.gz", lambda: bomb(b"", b"\0" * 10_000_000, 20)),
    "a growing certificate": ("p.json.gz", lambda: bomb(PROOF + b'"', b"x" * 1_000_000, 150)),
    "a certificate of lists": ("p.json.gz", lambda: bomb(PROOF + b"[", b"[]," * 1000, 15_000)),
    "a deep certificate": ("p.json", lambda: PROOF + b"[" * 100_000),
    "a certificate of digits": ("p.json", lambda: PROOF + b"9" * 5_000_000),
}

# A process counts the memory of the one that it was started from: so a small one stands in between.
STARTER = """
import subprocess, sys
subprocess.run([sys.executable, "-c", sys.argv[1], *sys.argv[2:]])
"""
# A fork for each command, so that nothing is imported twice.
COMMANDS = """
import json, os, sys
from typer.testing import CliRunner
from nullpose.cli.app import app
import nullpose.certificate
CliRunner().invoke(app, ["check", "examples/paper.toml"])  # which imports what most of them need
for words in json.loads(sys.argv[1]):
    child = os.fork()
    if not child:
        done = CliRunner().invoke(app, words)
        print(json.dumps([done.exit_code, done.output]), flush=True)
        os._exit(0)
    _, _, used = os.wait4(child, 0)
    print(json.dumps([used.ru_utime + used.ru_stime, used.ru_maxrss]), flush=True)
"""


def run_apart(commands: list[tuple[str, ...]]) -> list[tuple[int, str]]:
    """Run commands, each in a process that takes few seconds and less than 200 MB: exit codes, outputs."""
    words = [sys.executable, "-S", "-c", STARTER, COMMANDS, json.dumps(commands)]
    done = subprocess.run(words, capture_output=True, check=True, timeout=600)
    assert done.stderr == b""
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(lines) == 2 * len(commands)
    for command, (seconds, most) in zip(commands, lines[1::2], strict=True):
        assert seconds < 40.0, command
        assert most < 200.0 * (2**20 if sys.platform == "darwin" else 2**10), command
    return [(code, output) for code, output in lines[::2]]


def test_hostile_files_are_refused_at_once(tmp_path: Path) -> None:
    """Within seconds, and in less than 200 MB, in words."""
    commands: list[tuple[str, ...]] = []
    for number, (name, content) in enumerate(HOSTILE.values()):
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / "s.toml").write_bytes(f'nodes_from = "{name}"\n'.encode() + SCENE)
        (folder / name).write_bytes(content())
        verb, file = ("verify", name) if name.startswith("p.") else ("check", "s.toml")
        commands.append((verb, str(folder / file)))
    for what, (code, output) in zip(HOSTILE, run_apart(commands), strict=True):
        assert (code, output.splitlines()[0].startswith("error: ")) == (2, True), what
        assert "Traceback" not in output, what
        assert len(output) < 10_000, what


def test_what_never_ends_is_not_read(tmp_path: Path) -> None:
    """A pipe that nobody writes, and a device, in the place of any input."""
    os.mkfifo(tmp_path / "pipe")
    os.mkfifo(tmp_path / "pipe.csv")
    (tmp_path / "named.toml").write_bytes(b'nodes_from = "pipe.csv"\n' + SCENE)
    verbs = (("check",), ("verify",), ("study", "run", "--out", str(tmp_path / "out")))
    commands = [(*verb, file) for verb in verbs for file in ("/dev/zero", str(tmp_path / "pipe"))]
    commands.append(("check", str(tmp_path / "named.toml")))
    for command, (code, output) in zip(commands, run_apart(commands), strict=True):
        assert code == 2, command
        assert "a device or a pipe" in output, command
