"""Work out the numbers of the page "Do I need an omnidirectional drone?".

Each table is a CSV file beside this script, which ``airframes.py`` draws. Without arguments all but the
random fields are worked out, which takes minutes; ``fields`` and ``field-arrays`` take longer, and go on
where they were stopped. Their files are kept: remove them to begin anew.
"""

from __future__ import annotations

import csv
import itertools
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

import nullpose
from nullpose.physics.types import FloatArray
from nullpose.solver import solve
from nullpose.solver.robust import guarantee
from nullpose.study import AIRFRAME_CASES, Case, spaced

FOLDER = Path(__file__).parent
PAPER = nullpose.load(FOLDER.parents[1] / "examples" / "paper.toml")
POWER = "jammers.M.power_w"
NAMES = ("level-vertical", "level-horizontal", "tilt-10-horizontal", "tilt-30-horizontal", "omnidirectional")
CASES = tuple(case for case in AIRFRAME_CASES if case.name in NAMES)
OMNIDIRECTIONAL = CASES[-1]

LEVELS = spaced(1e-3, 1e4, 57, log=True)
TILT_LEVELS = (0.1, 1.0, 10.0, 100.0)
TILT_GAP = 1e-4
TILTS_DEG = [2.5 * step for step in range(37)]
MOUNTS_DEG = (0.0, 45.0, 90.0)
SIZES = (1, 2, 3, 4, 6, 8)
ERROR_LEVEL = 100.0
ATTITUDES_DEG = [0.5 * step for step in range(11)]
RADII_M = [0.3 * step for step in range(13)]
ERROR_CASES = ("tilt-10-horizontal", "omnidirectional")

NODES, JAMMERS, SCENES = (2, 5, 10), (1, 3), 16
FIELD_GAP, FIELD_LIMIT_S = 1e-3, 120.0
FIELD_SIZES = (2, 4, 8)
ARRAY_FIELDS = 48  # the first of them

Row = list[object]


def at(level: float) -> nullpose.Scenario:
    """Return the paper's scene at a jamming power.

    Args:
        level: the jammer's power over the nodes'.
    """
    return nullpose.apply_overrides(PAPER, [f"{POWER}={level!r}"])


def certified(case: Case, scenario: nullpose.Scenario, gap: float = 1e-6) -> nullpose.Result:
    """Return what a vehicle reaches, certified.

    Args:
        case: the vehicle.
        scenario: the paper's scene.
        gap: to which it is to be certified, relative.
    """
    solution = nullpose.solve(case.on(scenario), gap=gap, time_limit_s=600.0)
    if solution.status is not nullpose.Status.CERTIFIED:
        raise RuntimeError(f"{case.name}: {solution.reason}")
    return solution


def paper_rows() -> Iterator[Row]:
    """Yield what each vehicle reaches at each jamming power."""
    yield ["jamming_ratio", *(case.name for case in CASES)]
    for level in LEVELS:
        yield [level, *(certified(case, at(level)).objective.value for case in CASES)]


def array_value(scenario: nullpose.Scenario, elements: int, *, certify: bool = True) -> float:
    """Return what an array on a level vehicle reaches: a line of upright dipoles, half a wavelength apart.

    Args:
        scenario: what to solve.
        elements: how many dipoles.
        certify: whether to prove what can be.
    """
    array = nullpose.Array(elements=elements, layout="linear", spacing_wavelengths=0.5)
    return solve(scenario.model_copy(update={"array": array}), certify=certify).objective.value


def tilt_rows() -> Iterator[Row]:
    """Yield what each tilt reaches, for each way to mount the dipole, at several jamming powers."""
    yield ["jamming_ratio", "mount_deg", "tilt_max_deg", "value"]
    for level in TILT_LEVELS:
        for mount_deg in MOUNTS_DEG:
            for tilt_deg in TILTS_DEG:
                airframe = nullpose.Airframe(tilt_max_deg=tilt_deg, mount_deg=mount_deg)
                case = Case(name="tilt", airframe=airframe)
                yield [level, mount_deg, tilt_deg, certified(case, at(level), TILT_GAP).objective.value]


def array_rows() -> Iterator[Row]:
    """Yield what arrays of several sizes reach, and the omnidirectional dipole beside them."""
    yield ["jamming_ratio", "elements", "digital", "omnidirectional"]
    for level in TILT_LEVELS:
        whole = certified(OMNIDIRECTIONAL, at(level)).objective.value
        for elements in SIZES:
            yield [level, elements, array_value(at(level), elements), whole]


def error_rows() -> Iterator[Row]:
    """Yield what the nominal and the robust pose guarantee, against each kind of error alone."""
    yield ["case", "attitude_error_deg", "jammer_radius_m", "nominal_pose", "robust_pose", "upper_bound"]
    sizes = [(degrees, 0.0) for degrees in ATTITUDES_DEG] + [(0.0, radius_m) for radius_m in RADII_M[1:]]
    for case in (case for case in CASES if case.name in ERROR_CASES):
        for degrees, radius_m in sizes:
            data = at(ERROR_LEVEL).to_dict()
            data["receiver"]["attitude_error_deg"] = degrees
            data["jammers"][0]["uncertainty_m"] = radius_m
            scenario = case.on(nullpose.Scenario.from_dict(data))
            pose = certified(case, scenario).pose
            nominal = guarantee(scenario, pose.position_m, pose.antenna_axis).lower
            robust = solve(scenario, robust=True)
            best = max(nominal, robust.details.robust.guaranteed)
            yield [case.name, degrees, radius_m, nominal, best, robust.objective.upper_bound]


def field(nodes: int, jammers: int, index: int) -> nullpose.Scenario:
    """Return a random field: 200 m by 200 m, seen from 20 m to 120 m.

    Nodes of 0.1 W at 2.4 GHz into -95 dBm of noise; jammers of 0.1 to 100 times that power, spread evenly in
    decibels.

    Args:
        nodes: how many nodes.
        jammers: how many jammers.
        index: which of the fields of this kind; also the seed.
    """
    rng = np.random.default_rng([nodes, jammers, index])
    return nullpose.Scenario.from_dict(
        {
            "name": f"field {index} with {nodes} nodes and {jammers} jammers",
            "airspace": {
                "altitude_m": [20.0, 120.0],
                "x_m": [-100.0, 300.0],
                "y_m": [-100.0, 300.0],
                "keep_out_m": 10.0,
            },
            "receiver": {"noise_dbm": -95.0, "frequency_hz": 2.4e9},
            "nodes": [{"position_m": place(rng, 1.0), "power_w": 0.1} for _ in range(nodes)],
            "jammers": [
                {"position_m": place(rng, 2.0), "power_w": 0.1 * 10.0 ** rng.uniform(-1.0, 2.0)}
                for _ in range(jammers)
            ],
        }
    )


def place(rng: np.random.Generator, height_m: float) -> list[float]:
    """Return a random place in a field.

    Args:
        rng: where randomness comes from.
        height_m: above the ground.
    """
    corner: FloatArray = rng.uniform(0.0, 200.0, 2)
    return [*(round(float(side), 2) for side in corner), height_m]


def fields(done: int) -> Iterator[tuple[Row, nullpose.Scenario]]:
    """Yield each field with its number of nodes, of jammers, and its index, those that are done left out.

    Args:
        done: how many to leave out.
    """
    kinds = [(n, k, i) for i in range(SCENES) for k in JAMMERS for n in NODES]
    for nodes, jammers, index in kinds[done:]:
        yield [nodes, jammers, index], field(nodes, jammers, index)


def field_rows(done: int) -> Iterator[Row]:
    """Yield what each vehicle reaches in each random field, with its bound.

    Args:
        done: how many fields to leave out.
    """
    names = [f"{case.name}{end}" for case in CASES for end in ("", "-bound")]
    yield ["nodes", "jammers", "index", *names]
    for head, scenario in fields(done):
        numbers: Row = []
        for case in CASES:
            objective = nullpose.solve(case.on(scenario), gap=FIELD_GAP, time_limit_s=FIELD_LIMIT_S).objective
            numbers += [objective.value, objective.upper_bound]
        yield [*head, *numbers]


def field_array_rows(done: int) -> Iterator[Row]:
    """Yield what searches find that arrays reach in the first random fields.

    Args:
        done: how many fields to leave out.
    """
    yield ["nodes", "jammers", "index", *(f"array-{size}" for size in FIELD_SIZES)]
    for head, scenario in itertools.islice(fields(done), ARRAY_FIELDS - done):
        yield [*head, *(array_value(scenario, size, certify=False) for size in FIELD_SIZES)]


TABLES: dict[str, Callable[[], Iterator[Row]]] = {
    "paper": paper_rows,
    "tilt": tilt_rows,
    "arrays": array_rows,
    "errors": error_rows,
}
LONG: dict[str, Callable[[int], Iterator[Row]]] = {"fields": field_rows, "field-arrays": field_array_rows}


def path_of(name: str) -> Path:
    """Return where a table is kept.

    Args:
        name: of the table.
    """
    return FOLDER / f"airframes-{name}.csv"


def write(name: str) -> None:
    """Write a table, or the rest of one of those that take long.

    Args:
        name: of the table.
    """
    path = path_of(name)
    if name in TABLES:
        rows, mode, skip = TABLES[name](), "w", 0
    else:
        done = max(0, len(path.read_text(encoding="utf-8").splitlines()) - 1) if path.exists() else 0
        rows, mode, skip = LONG[name](done), "a", 1 if path.exists() else 0
    with path.open(mode, encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        for index, row in enumerate(rows):
            if index >= skip:
                writer.writerow([f"{cell:.9g}" if isinstance(cell, float) else cell for cell in row])
                file.flush()


if __name__ == "__main__":
    for table in sys.argv[1:] or TABLES:
        write(table)
