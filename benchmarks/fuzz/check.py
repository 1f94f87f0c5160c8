"""One damaged file given to the command, and what was wrong with how that ended."""

from __future__ import annotations

import json
import random
import subprocess
import sys
import time
import traceback
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from typer.testing import CliRunner

from benchmarks.fuzz.mutations import mutated
from benchmarks.fuzz.targets import Target
from nullpose.cli.app import app

__all__ = ["LONGEST_S", "MOST_MB", "Outcome", "check_file", "damaged", "in_a_process", "in_this_process"]

LONGEST_S = 2.0
"""Processor time that reading one file may take [s]; a process of its own takes this beside its start."""

MOST_MB = 300.0
"""Memory that a process may take [MB]."""

_LONGEST_MESSAGE = 20_000  # characters


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """How the command ended.

    Args:
        kind: of the file.
        number: of the damage.
        code: the exit code.
        seconds: processor time.
        megabytes: the most memory; 0 where it ran in this process.
        faults: what was wrong with that, in words.
        content: the damaged file.
    """

    kind: str
    number: int
    code: int
    seconds: float
    megabytes: float
    faults: tuple[str, ...]
    content: bytes


def damaged(target: Target, number: int) -> bytes:
    """Return a target's content with the damage of some number.

    Args:
        target: the kind of file.
        number: decides the damage.
    """
    return mutated(target.content, random.Random(number))


def check_file(target: Target, number: int, *, fresh: bool = False, start_s: float = 0.0) -> Outcome:
    """Return how the command ends with a damaged file.

    Args:
        target: the kind of file.
        number: decides the damage.
        fresh: in a process of its own, which tells its memory too.
        start_s: processor time that such a process takes to start.
    """
    content = damaged(target, number)
    with TemporaryDirectory() as folder:
        arguments = target.written(Path(folder), content)
        code, seconds, megabytes, output = (in_a_process if fresh else in_this_process)(arguments)
    seconds -= start_s
    allowed = (0, 1, 2) if arguments[0] == "verify" and "rejected" in output else (0, 2)
    wrong = {
        f"exit code {code}": code not in allowed,
        f"a traceback: {output[-600:]}": "Traceback" in output,
        f"{seconds:.1f} s": seconds > LONGEST_S,
        f"{megabytes:.0f} MB": megabytes > MOST_MB,
        f"a message of {len(output)} characters": code == 2 and len(output) > _LONGEST_MESSAGE,
    }
    return Outcome(
        kind=target.kind,
        number=number,
        code=code,
        seconds=seconds,
        megabytes=megabytes,
        faults=tuple(words for words, so in wrong.items() if so),
        content=content,
    )


def in_this_process(arguments: Sequence[str]) -> tuple[int, float, float, str]:
    """Return the same of the command in this process, but for the memory, which is not told apart.

    Args:
        arguments: of the command.
    """
    began = time.process_time()
    result = CliRunner(env={"COLUMNS": "200"}).invoke(app, list(arguments))
    seconds = time.process_time() - began
    output = result.output
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        output += "".join(traceback.format_exception(result.exception))
    return result.exit_code, seconds, 0.0, output


# A process counts the memory of the one that it was started from: so a small one stands in between.
_STARTER = """
import json, os, resource, subprocess, sys
done = subprocess.run([sys.executable, "-m", "nullpose", *sys.argv[1:]], stdout=2)
usage = resource.getrusage(resource.RUSAGE_CHILDREN)
print(json.dumps([done.returncode, usage.ru_utime + usage.ru_stime, usage.ru_maxrss]))
"""


def in_a_process(arguments: Sequence[str]) -> tuple[int, float, float, str]:
    """Return exit code, processor time [s], memory [MB] and output of the command in a process of its own.

    Args:
        arguments: of the command.
    """
    done = subprocess.run(
        [sys.executable, "-S", "-c", _STARTER, *arguments], capture_output=True, check=True, timeout=120
    )
    code, seconds, most = json.loads(done.stdout)
    megabytes = most / (2**20 if sys.platform == "darwin" else 2**10)
    return code, seconds, megabytes, done.stderr.decode(errors="replace")
