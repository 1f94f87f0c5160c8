"""Faults for programs: with --json the last line of standard error is a JSON object."""

import json
from collections.abc import Callable

import pytest
from typer.testing import Result

Run = Callable[..., Result]


@pytest.mark.parametrize(
    ("arguments", "path", "words"),
    [
        (("--set", "jammers.M.power_w=-1"), "jammers[0].power_w", "must be a power in W"),
        (("--scheme", "optimun"), "", "did you mean 'optimum'?"),
        (("--sceme", "optimum"), "", "--sceme"),
    ],
)
def test_a_fault_is_an_object(
    run: Run, paper: str, arguments: tuple[str, ...], path: str, words: str
) -> None:
    """It has every fault with its path, and the exit code; standard output stays empty."""
    result = run("solve", paper, "--json", *arguments)
    told = json.loads(result.stderr.splitlines()[-1])
    assert (result.exit_code, result.stdout, told["exit_code"]) == (2, "", 2)
    assert list(told) == ["error", "source", "faults", "exit_code"]
    assert told["faults"][0]["path"] == path
    assert words in told["faults"][0]["message"]


def test_every_fault_is_there(run: Run, paper: str) -> None:
    """More than the twenty that a text tells."""
    settings = [word for i in range(30) for word in ("--set", f"jammers.M{i}.power_w=1")]
    told = json.loads(run("check", paper, "--json", *settings).stderr)
    assert (told["error"], len(told["faults"])) == ("ScenarioError", 30)
