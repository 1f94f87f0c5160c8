"""Kernels on disk: what is damaged is compiled again, and where nothing can be kept that is said once."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]

KERNELS = """
from nullpose.solver.kernels.compiler.jit import kernel


@kernel
def twice(x):
    return 2.0 * x


@kernel
def thrice(x):
    return 3.0 * x
"""

DAMAGES = """
import sys
from importlib import reload
from pathlib import Path

import numpy as np
import tiny

def run():
    reload(tiny)  # as a new process: all is loaded anew
    assert (tiny.twice(1.0), tiny.thrice(1.0)) == (2.0, 3.0)
    return {path: path.read_bytes() for path in folder.glob("*.nbc")}

folder = Path(tiny.twice.stats.cache_path)
rng = np.random.default_rng(14)
sound = run()
assert len(sound) == 2
for damage in range(COUNT):
    path = list(sound)[damage % 2]
    content = bytearray(sound[path])
    if damage % 3 == 0:
        content = content[: rng.integers(len(content))]
    elif damage < 4:
        content.clear()
    else:
        content[rng.integers(len(content))] ^= 1 << int(rng.integers(8))
    path.write_bytes(content)
    healed = run()
    assert healed.keys() == sound.keys()
    assert healed[path] != bytes(content)
    compiled = tiny.twice.stats.cache_misses, tiny.thrice.stats.cache_misses
    assert sum(map(len, compiled)) == 1
    sound = healed
run()
assert not tiny.twice.stats.cache_misses
print("sound")
"""

ONCE = "from tiny import thrice, twice; print(twice(1.0), thrice(1.0))"

NO_ROOM = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))\n"


OTHER_SOURCES = """
from importlib import reload

import tiny
from nullpose.solver.kernels.compiler import linked

for sources, misses in (("old", 1), ("old", 0), ("new", 1), ("new", 0), ("old", 0)):
    linked.digest_of_sources = lambda: sources
    reload(tiny)
    assert tiny.twice(1.0) == 2.0
    assert sum(tiny.twice.stats.cache_misses.values()) == misses
"""


def run(program: str, folder: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """Runs a program that has the kernels in a module, ``tiny``."""
    (folder / "tiny.py").write_text(KERNELS, encoding="utf-8")
    path = os.pathsep.join([str(folder), *sys.path])
    environment = os.environ | {"PYTHONPATH": path, "NUMBA_CACHE_DIR": str(folder / "kernels")} | environment
    return subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True)


@pytest.mark.parametrize("count", [18, pytest.param(60, marks=pytest.mark.slow)])
def test_what_is_damaged_is_compiled_again(tmp_path: Path, count: int) -> None:
    """Truncated, empty, or with one bit turned: never loaded, replaced by what is sound, and only that."""
    done = run(DAMAGES.replace("COUNT", str(count)), tmp_path)
    assert (done.stdout, done.stderr) == ("sound\n", "")


def test_what_is_made_of_other_sources_is_not_run(tmp_path: Path) -> None:
    """Not even if a process that began with them keeps it after the sources have changed."""
    done = run(OTHER_SOURCES, tmp_path)
    assert done.returncode == 0, done.stderr


@pytest.mark.grid
def test_a_folder_without_room_is_said_once(tmp_path: Path) -> None:
    """Kernels run all the same, and standard error has one line that says why they are not kept."""
    done = run(NO_ROOM + ONCE, tmp_path)
    assert done.stdout == "2.0 3.0\n"
    assert done.stderr.count("\n") == 1
    assert "cannot be kept in" in done.stderr
    assert not list((tmp_path / "kernels").rglob("*.nbc"))


def test_a_folder_that_cannot_be_written_is_said_once(tmp_path: Path) -> None:
    """Likewise where no folder can be made at all."""
    (tmp_path / "file").touch()
    done = run(
        ONCE,
        tmp_path,
        NUMBA_CACHE_DIR=str(tmp_path / "file" / "kernels"),
        NUMBA_CACHE_LOCATOR_CLASSES="UserProvidedCacheLocator",
    )
    assert done.stdout == "2.0 3.0\n"
    assert done.stderr.count("\n") == 1
    assert "NUMBA_CACHE_DIR" in done.stderr


NO_LOCKS = """
import errno
import fcntl
import time
from nullpose.solver.background_compiler import BackgroundCompiler
from tiny import twice

def refuse(*_):
    raise OSError(errno.ENOLCK, "No locks available")

fcntl.flock = refuse
compiler = BackgroundCompiler()
with compiler.in_use():
    found = twice(1.0)
    while compiler.is_busy():
        time.sleep(0.1)
    print(found)
"""


@pytest.mark.grid
def test_a_folder_without_locks_keeps_kernels(tmp_path: Path) -> None:
    """Some network folders have no locks: kernels are compiled and kept there, and nothing is said."""
    done = run(NO_LOCKS, tmp_path)
    assert (done.stdout, done.stderr) == ("2.0\n", "")
    assert list((tmp_path / "kernels").rglob("tiny.twice*.nbc"))


GOES_ON = """
from nullpose.solver.background_compiler import BackgroundCompiler
from tiny import twice

with BackgroundCompiler().in_use():
    print(twice(1.0))
"""


def test_compiling_goes_on_after_the_program(tmp_path: Path) -> None:
    """Python has the answer at once, and the kernel is kept although its program has ended."""
    assert run(GOES_ON, tmp_path).stdout == "2.0\n"
    kept = lambda: list((tmp_path / "kernels").rglob("tiny.twice*.nbc"))  # noqa: E731
    assert not kept()
    end = time.monotonic() + 60.0
    while not kept() and time.monotonic() < end:
        time.sleep(0.05)
    assert kept()


SLOW = """
from nullpose.solver.kernels.compiler.jit import heap_kernel, inner_heap_kernel
import numpy as np


@inner_heap_kernel
def one():
    return np.ones(1)[0]


@heap_kernel
def count(total, n):
    for _ in range(n):
        total[0] += one()
    return total[0]
"""

HANDED_OVER = """
import time
import numpy as np
from nullpose.solver.background_compiler import BackgroundCompiler
from nullpose.solver.compiling import working_clock
from nullpose.solver.kernels.compiler import interpreted
from slow import count

total = np.zeros(1)
with BackgroundCompiler().in_use():
    worked_s, wall_s = working_clock(), time.perf_counter()
    found = count(total, 20_000_000)
    vain_s = time.perf_counter() - wall_s - (working_clock() - worked_s)
    print(found, total[0], vain_s > 0.5 * interpreted.vain_s > 0.0)
"""

AFTER_THE_LAST = """
import time
import numpy as np
from nullpose.solver.background_compiler import BackgroundCompiler
from nullpose.solver.compiling import limit_clock
from slow import count

compiler = BackgroundCompiler()
with compiler.in_use():
    count(np.zeros(1), 1)
    began = limit_clock()
    time.sleep(0.3)
    print(limit_clock() - began < 0.2)
    for process in compiler._processes:
        process.wait()
    limit_clock()
    time.sleep(0.3)
    began = limit_clock()
    time.sleep(0.3)
    print(limit_clock() - began > 0.2)
"""

AT_A_LIMIT = """
import time
import numpy as np
from nullpose.solver.background_compiler import BackgroundCompiler
from nullpose.solver.compiling import limit_clock
from nullpose.solver.kernels.compiler.interpreted import ended_when
from slow import count

total = np.zeros(1)
deadline = limit_clock() + 0.2
with BackgroundCompiler(counts=True).in_use():
    with ended_when(lambda: limit_clock() > deadline):
        count(total, 10**15)
    print(total[0])
"""


def test_machine_code_takes_over(tmp_path: Path) -> None:
    """What would take Python minutes ends soon after it is compiled, and nothing of it is counted twice."""
    (tmp_path / "slow.py").write_text(SLOW, encoding="utf-8")
    done = run(HANDED_OVER, tmp_path)
    assert (done.stdout, done.stderr) == ("20000000.0 20000000.0 True\n", "")


@pytest.mark.grid
def test_a_limit_begins_with_the_last_kernel(tmp_path: Path) -> None:
    """The clock stands still while kernels are compiled, and not after that, whoever looks or does not."""
    (tmp_path / "slow.py").write_text(SLOW, encoding="utf-8")
    assert run(AFTER_THE_LAST, tmp_path).stdout == "True\nTrue\n"


def test_a_limit_ends_what_python_runs(tmp_path: Path) -> None:
    """A limit that counts compiling ends a call of years before its kernel is there; nothing of it counts."""
    (tmp_path / "slow.py").write_text(SLOW, encoding="utf-8")
    assert run(AT_A_LIMIT, tmp_path).stdout == "0.0\n"


def test_an_interrupt_leaves_arrays_as_they_were() -> None:
    """What Python has done of half a step is taken back: a proof goes on from there, or states its bound."""
    import numpy as np

    from nullpose.solver.kernels.compiler.interpreted import interpret
    from nullpose.solver.kernels.compiler.jit import kernel

    @kernel
    def interrupted(numbers: np.ndarray) -> None:
        numbers[0] = 2.0
        raise KeyboardInterrupt

    numbers = np.ones(3)
    with pytest.raises(KeyboardInterrupt):
        interpret(interrupted, (), numbers)
    np.testing.assert_array_equal(numbers, 1.0)
