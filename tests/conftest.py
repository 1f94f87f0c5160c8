"""What every test runs under: figures without a screen, the same hypothesis examples on every run, scenes."""

import gc
import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

# Before numpy is there: threads that share a small matrix take four times the processors' time.
os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"
os.environ["MPLBACKEND"] = "Agg"

import numpy as np
import pytest
from hypothesis import settings
from tests.reference.sizes import chosen
from tests.reference.whip import whip_rows

from nullpose.channel import ENVIRONMENTS, LinkChannel
from nullpose.channel.elevation import elevation_channel, with_profile
from nullpose.channel.power_law import constant_channel, power_law
from nullpose.scenario import Airspace, Jammer, Node, Receiver, Scenario
from nullpose.solver import SolveOptions, array_search
from nullpose.solver.kernels.bounds.worst_case_bound import worst_case

if TYPE_CHECKING:
    from nullpose.paper import Reproduction

# Compiling a kernel inside an example would break any deadline.
settings.register_profile("house", derandomize=True, deadline=None, max_examples=40)
settings.register_profile("random", derandomize=False, deadline=None, max_examples=100, print_blob=True)
settings.load_profile("house")

# No proof ends earlier because the machine is busy.
SolveOptions.__init__.__kwdefaults__["time_limit_s"] = 600.0

LONG_FILE_LINES = 350

Place = tuple[float, float, float]

BEGIN = """
import gc
from nullpose import load, solve
from nullpose.solver import best_axis
from nullpose.solver.compiling import compile_proof, compile_search
gc.disable()  # a fifth of the time that compiling takes
paper = "examples/paper.toml"
"""
COMPILE = (
    """
compile_proof()  # takes as long as all else, so that the searches are there when it ends
solve(load("examples/robust.toml"), gap=1.0, robust=True)
array = ["array.elements=2", "array.layout=linear", "array.spacing_wavelengths=0.5"]
solve(load(paper, overrides=array), gap=1e-2)  # wider ones need no box
""",
    """
compile_search()
solve(load(paper, overrides=["antenna.kind=half-wave"]), gap=1.0)
best_axis(load(paper), [1.0, 20.0, 9.0])
""",
)


def pytest_sessionstart(session: pytest.Session) -> None:
    """Compile the kernels, unless they are kept, before there are processes that would all do so."""
    option = session.config.option
    has_workers = getattr(option, "numprocesses", None) and not option.collectonly
    if has_workers and not list(Path(worst_case.stats.cache_path).glob("worst_case_bound.*.nbc")):
        at_work = [subprocess.Popen([sys.executable, "-c", BEGIN + program]) for program in COMPILE]
        assert [each.wait() for each in at_work] == [0, 0]


def pytest_collection_finish(session: pytest.Session) -> None:
    """Leave the modules and tests that were loaded out of every search for garbage."""
    gc.freeze()


@pytest.fixture(autouse=True, scope="module")
def _coarse(request: pytest.FixtureRequest) -> Iterator[None]:
    """Has arrays searched from a tenth of the states, and figures of few dots, where both are only made.

    tests/solver has all states, and tests/report the dots.
    """
    rooms = set(request.path.relative_to(Path(__file__).parent).parts[:2])
    with pytest.MonkeyPatch.context() as patch:
        if {"cli", "docs", "report", "study"} & rooms:
            patch.setattr(array_search, "_CLIMBED", 4)
        if {"cli", "docs"} & rooms or {"report", "study"} <= rooms:
            from matplotlib.figure import Figure

            def save(self: Figure, *paths: Any, draw: Any = Figure.savefig, **options: Any) -> None:
                is_frame = options.get("format") == "rgba"  # of a film, which has a size
                draw(self, *paths, **options if is_frame else options | {"dpi": 40})

            patch.setattr(Figure, "savefig", save)
        yield


@pytest.fixture(scope="session")
def scene() -> Callable[..., Scenario]:
    """Returns a builder: nodes and jammers with their powers (1 W if left out), altitudes and airspace."""

    def build(
        nodes_m: Sequence[Place],
        jammers_m: Sequence[Place] = (),
        *,
        node_powers_w: Sequence[float] | float = 1.0,
        jammer_powers_w: Sequence[float] | float = 1.0,
        altitude_m: tuple[float, float] = (8.0, 30.0),
        noise_w: float = 1e-3,
        **airspace: object,
    ) -> Scenario:
        return Scenario(
            airspace=Airspace(altitude_m=altitude_m, **airspace),
            receiver=Receiver(noise_w=noise_w, reference_gain_db=0.0),
            nodes=tuple(
                Node(position_m=tuple(map(float, at)), power_w=float(power))
                for at, power in zip(nodes_m, np.broadcast_to(node_powers_w, len(nodes_m)), strict=True)
            ),
            jammers=tuple(
                Jammer(position_m=tuple(map(float, at)), power_w=float(power))
                for at, power in zip(jammers_m, np.broadcast_to(jammer_powers_w, len(jammers_m)), strict=True)
            ),
        )

    return build


@pytest.fixture(scope="session")
def paper(scene: Callable[..., Scenario]) -> Callable[..., Scenario]:
    """Returns a builder: the paper's scene at a jamming-to-transmission power ratio, in any airspace."""

    def build(ratio: float = 1.0, **airspace: object) -> Scenario:
        return scene([(0, 0, 0), (0, 50, 0)], [(17, 15, 4)], jammer_powers_w=ratio, **airspace)

    return build


@pytest.fixture(scope="session")
def random_scene(scene: Callable[..., Scenario]) -> Callable[..., Scenario]:
    """Returns a builder: so many nodes and jammers on a field of 100 m, of a total jamming power."""

    def build(
        rng: np.random.Generator, nodes: int, jammers: int, jamming_w: float = 1.0, **airspace: object
    ) -> Scenario:
        return scene(
            rng.uniform([0.0, 0.0, 0.0], [100.0, 100.0, 5.0], (nodes, 3)),
            rng.uniform([0.0, 0.0, 0.0], [100.0, 100.0, 5.0], (jammers, 3)),
            node_powers_w=10.0 ** rng.uniform(-0.5, 0.5, nodes),
            jammer_powers_w=jamming_w / max(jammers, 1),
            **airspace,
        )

    return build


CHANNELS: dict[str, LinkChannel | None] = {
    "free space": None,
    "power law 1.6": power_law(1.6, 2.0),
    "power law 3": power_law(3.0, 1.0),
    "power law 6": power_law(6.0, 1.0),
    "suburban": elevation_channel(*ENVIRONMENTS["suburban"], average="power"),
    "urban in dB": elevation_channel(*ENVIRONMENTS["urban"], average="db"),
    "urban of exponent 2.8": elevation_channel(
        *ENVIRONMENTS["urban"], average="power", exponent=2.8, reference_distance_m=2.0
    ),
    "suburban of exponent 1.7 in dB": elevation_channel(
        *ENVIRONMENTS["suburban"], average="db", exponent=1.7
    ),
    "high-rise": elevation_channel(*ENVIRONMENTS["high-rise"], average="power"),
    "whip": with_profile(constant_channel(1.0), *zip(*whip_rows(), strict=True)),
    "whip by a law": with_profile(power_law(2.6, 2.0), *zip(*whip_rows(10.0), strict=True)),
    "whip in suburbs": with_profile(
        elevation_channel(*ENVIRONMENTS["suburban"], average="power"), *zip(*whip_rows(1.0), strict=True)
    ),
    "whip in town": with_profile(
        elevation_channel(*ENVIRONMENTS["urban"], average="db"), *zip(*whip_rows(10.0), strict=True)
    ),
}


FEW_CHANNELS = 0, 1, 6, 7, 12  # one of each factor, of each average and of exponents either side of 2


@pytest.fixture(
    params=chosen(zip(CHANNELS.values(), strict=True), FEW_CHANNELS), ids=CHANNELS, scope="session"
)
def channel(request: pytest.FixtureRequest) -> LinkChannel | None:
    """A channel of each kind."""
    return request.param  # type: ignore[no-any-return]


@pytest.fixture(scope="session")
def reproduction(tmp_path_factory: pytest.TempPathFactory) -> "Reproduction":
    """The paper's figures from a jamming level a decade, and one below that where the needle begins."""
    from nullpose.paper import reproduce

    levels = sorted([*(10.0**exponent for exponent in range(-3, 7)), 0.3])
    folder = tmp_path_factory.mktemp("reproduction")
    return reproduce(folder, levels=levels, printed_levels=[1e-3, 1.0, 1e5, 1e6])


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Name the source files that are getting long, before they reach the limit of tests/test_house.py."""
    source = Path(__file__).parents[1] / "src" / "nullpose"
    lengths = {path: len(path.read_text(encoding="utf-8").splitlines()) for path in source.rglob("*.py")}
    long_files = {path: lines for path, lines in sorted(lengths.items()) if lines > LONG_FILE_LINES}
    if long_files:
        terminalreporter.section(f"source files over {LONG_FILE_LINES} lines")
        for path, lines in long_files.items():
            terminalreporter.line(f"{path.relative_to(source)}: {lines}")
