"""The program as a whole: its help, its version, and what it does not import."""

import json
import math
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import CliRunner

from nullpose import __version__, json_schema
from nullpose.cli.app import app
from nullpose.problem.schemes import Scheme
from scenes import Run

Process = Callable[..., subprocess.CompletedProcess[str]]

SCENE, PROOF = "--set --allow-outside --at", "--gap --time-limit --node-limit --seed"
VERBS = {
    "solve": f"{SCENE} {PROOF} --scheme --fast --robust --hover --off --null-jammer --certificate --verify "
    "--export --figure --width --json",
    "trajectory": "--set --allow-outside --maximise --gap-db --time-limit --window --out --json",
    "compare": f"{SCENE} {PROOF} --airframes --fast --figure --width --json",
    "evaluate": f"{SCENE} {PROOF} --pose --pose-lat-lon --attitude --poses --off --json",
    "map": f"{SCENE} {PROOF} --scheme --altitude --cells --fast --out --width --json",
    "sweep": f"{SCENE} {PROOF} --from --to --points --log --linear --scheme --reach --mount --fast --bounds "
    "--out --width --json",
    "vehicle": f"{SCENE} {PROOF} --reach --loss-db --mount --figure --width --json",
    "verify": "--scenario --show --allow-outside --json",
    "reproduce": "--out --seed --json",
    "check": f"{SCENE} --json",
    "schema": "",
}


def test_help_lists_every_verb(run: Run) -> None:
    """The program's help names each verb and the exit codes, asked for or not."""
    assert "Usage: nullpose" in run().output
    result = run("--help")
    assert result.exit_code == 0
    assert all(f" {verb} " in result.stdout for verb in VERBS)
    assert "Exit codes: 0 success, 2 bad input or usage" in result.stdout


@pytest.mark.parametrize("verb", VERBS)
def test_help_of_a_verb_lists_its_options(run: Run, verb: str) -> None:
    """A verb's help names each of its options and no other."""
    result = run(verb, "--help")
    words = (word.rstrip(",") for word in result.stdout.replace("│", " ").split())
    named = {word for word in words if word.startswith("--") and word[-1] not in ".:"}  # which end a sentence
    assert result.exit_code == 0
    assert named - {"--help"} == set(VERBS[verb].split())


def test_help_imports_nothing_heavy() -> None:
    """The command line can be built without the libraries that the verbs need."""
    heavy = ("numpy", "numba", "pydantic", "scipy", "matplotlib")
    code = f"import sys, nullpose.cli.app; print([name for name in {heavy!r} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_solve_imports_neither_scipy_nor_matplotlib(paper: str) -> None:
    """A single solve loads only what it needs, and what it leaves out can be had afterwards."""
    code = (
        "import sys; from typer.testing import CliRunner; from nullpose.cli.app import app;"
        f"assert CliRunner().invoke(app, ['solve', {paper!r}]).exit_code == 0;"
        "print([name for name in ('scipy.linalg', 'scipy.optimize', 'matplotlib') if name in sys.modules]);"
        "import scipy.linalg.cython_blas, scipy.optimize"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_version(process: Process) -> None:
    """`--version` prints one line."""
    done = process("--version")
    assert (done.returncode, done.stdout, done.stderr) == (0, f"nullpose {__version__}\n", "")
    assert "--install-completion" in process("--help").stdout


@pytest.mark.parametrize("width", ["60", "80", "200"])
def test_help_keeps_words_whole(run: Run, width: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The names of schemes stand whole on a line, and what is in brackets is shown."""
    monkeypatch.setenv("COLUMNS", width)
    lines = run("solve", "--help").stdout.splitlines()
    for name in Scheme:
        assert any(line.split()[:1] == [name.value] for line in lines)
    assert "what [origin] states" in " ".join(run("evaluate", "--help").stdout.split())


def test_best_ratio_is_that_of_the_closest_point(run: Run, paper: str) -> None:
    """Straight above a node at the lowest altitude, broadside: P / (8^2 sigma^2)."""
    answer = json.loads(run("check", paper, "--json").stdout)
    assert answer["nodes"][0]["nearest_m"] == pytest.approx(8.0)
    assert answer["nodes"][0]["best_power_to_noise_db"] == pytest.approx(10.0 * math.log10(1e3 / 64.0))
    assert answer["jammers"][0]["nearest_m"] == pytest.approx(4.0)


def test_schema_is_printed_whole(run: Run) -> None:
    """Standard output is the schema and nothing else."""
    result = run("schema")
    assert (result.exit_code, result.stderr) == (0, "")
    assert json.loads(result.stdout) == json_schema()


def test_a_missing_extra_ends_with_code_2(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without viser the verb says in one line how to install it."""
    monkeypatch.setitem(sys.modules, "viser", None)
    result = CliRunner().invoke(app, ["studio", str(Path(__file__).parents[2] / "examples" / "paper.toml")])
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
    assert "pip install -e '.[studio]'" in result.stderr


def test_a_faulty_file_ends_with_code_2(tmp_path: Path) -> None:
    """A file at fault is refused before anything is opened, with its faults by path."""
    path = tmp_path / "broken.toml"
    path.write_text("[airspace]\naltitude_m = 3\n")
    result = CliRunner().invoke(app, ["studio", str(path)])
    assert result.exit_code == 2
    assert "airspace.altitude_m" in result.stderr
