"""Work out the numbers of the page "Which objective, and does it matter?".

Each table is a CSV file beside this script, which ``objectives.py`` draws. Both take about a minute. The
random fields go on where they were stopped; their file is kept: remove it to begin anew.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

import nullpose
from nullpose.study import spaced

FOLDER = Path(__file__).parent
PAPER = nullpose.load(FOLDER.parents[1] / "examples" / "paper.toml")
OBJECTIVES = ("min-sinr", "proportional-fair", "sum-rate")
SCHEMES = ("optimum", "zero-interference", "maximum-gain", "vertical")
LEVELS = spaced(1e-3, 1e4, 29, log=True)
FIELDS, GAP, PAPER_GAP, LIMIT_S = 200, 1e-3, 1e-6, 120.0
NOISES_W = (1e-3, 1e-6)  # of every other field: the paper's, and 30 dB less

Row = list[object]


def under(scenario: nullpose.Scenario, objective: str) -> nullpose.Scenario:
    """Return a scene with another objective.

    Args:
        scenario: the scene.
        objective: its name.
    """
    return scenario.model_copy(update={"objective": objective})


def values_at(scenario: nullpose.Scenario, pose: nullpose.Pose) -> list[float]:
    """Return what each objective is at a pose: two in dB, and the mean rate of a node in bits/s/Hz.

    Args:
        scenario: the scene, under any objective.
        pose: where the drone is.
    """
    sinr = np.array([link.sinr for link in nullpose.evaluate(scenario, pose)])
    return [to_db(sinr.min()), to_db(np.exp(np.mean(np.log(sinr)))), float(np.mean(np.log2(1.0 + sinr)))]


def to_db(ratio: float) -> float:
    """Return a power ratio in dB."""
    return 10.0 * float(np.log10(ratio))


def axis_of(pose: nullpose.Pose) -> list[float]:
    """Return how far the antenna's axis is from the vertical, in degrees, and its azimuth from north."""
    east, north, up = pose.antenna_axis if pose.antenna_axis[2] >= 0.0 else -pose.antenna_axis
    return [float(np.degrees(np.arccos(min(1.0, up)))), float(np.degrees(np.arctan2(east, north)))]


def paper_rows() -> Iterator[Row]:
    """Yield each scheme under each objective at each jamming power, and the values of all at its pose."""
    head = ["jamming_ratio", "objective", "scheme", "status", "value", "upper_bound", "x_m", "y_m", "z_m"]
    yield [*head, "tilt_deg", "azimuth_deg", *(f"{name}-here" for name in OBJECTIVES)]
    for level in LEVELS:
        scene = nullpose.apply_overrides(PAPER, [f"jammers.M.power_w={level!r}"])
        for objective in OBJECTIVES:
            for scheme in SCHEMES:
                found = nullpose.solve(under(scene, objective), scheme, gap=PAPER_GAP, time_limit_s=LIMIT_S)
                number, place = found.objective, found.pose.position_m.tolist()
                ends: Row = [found.status.value, number.value, number.upper_bound, *place]
                here = values_at(scene, found.pose)
                yield [level, objective, scheme, *ends, *axis_of(found.pose), *here]


def field(index: int) -> nullpose.Scenario:
    """Return a random field: 2 to 20 nodes of 1 W on 100 m by 100 m and up to 3 jammers, seen from 8 to 30 m.

    Jammers have 0.01 to 100 times a node's power, spread evenly in decibels. A node 32 m away has an SNR of
    0 dB in every other field, with the paper's noise, and of 30 dB in the rest.

    Args:
        index: which of the fields; also the seed.
    """
    rng = np.random.default_rng(index)
    nodes, jammers = int(rng.integers(2, 21)), int(rng.integers(0, 4))
    places = np.round(rng.uniform(-50.0, 50.0, (nodes + jammers, 2)), 2)
    points = [[float(x), float(y), 0.0] for x, y in places]
    powers = 10.0 ** rng.uniform(-2.0, 2.0, jammers)
    return nullpose.Scenario.from_arrays(
        points[:nodes],
        points[nodes:],
        jammer_power_w=powers,
        noise_w=NOISES_W[index % 2],
        altitude_m=(8.0, 30.0),
        airspace={"x_m": (-150.0, 150.0), "y_m": (-150.0, 150.0)},
    )


def power_db(scenario: nullpose.Scenario, pose: nullpose.Pose, mean_rate: float) -> float:
    """Return by how many dB all nodes have to raise their power for a mean rate at a pose.

    Args:
        scenario: the scene.
        pose: where the drone is.
        mean_rate: to be reached, bits/s/Hz.
    """
    sinr = np.array([link.sinr for link in nullpose.evaluate(scenario, pose)])
    missing = lambda more_db: float(np.mean(np.log2(1.0 + sinr * 10.0 ** (0.1 * more_db)))) - mean_rate  # noqa: E731
    return float(brentq(missing, -1.0, 100.0))


def field_rows(done: int) -> Iterator[Row]:
    """Yield, for each random field and objective, the best pose and the best upright one, and their values.

    Args:
        done: how many rows to leave out.
    """
    head = ["index", "nodes", "jammers", "noise_w", "objective", "status", "value", "upper_bound"]
    head += ["x_m", "y_m", "z_m", "tilt_deg", *(f"{name}-here" for name in OBJECTIVES)]
    yield [*head, "upright_status", *(f"{name}-upright" for name in OBJECTIVES), "power_db"]
    for number in range(done, FIELDS * len(OBJECTIVES)):
        index, which = divmod(number, len(OBJECTIVES))
        scene = field(index)
        asked = under(scene, OBJECTIVES[which])
        best, upright = (
            nullpose.solve(asked, scheme, gap=GAP, time_limit_s=LIMIT_S) for scheme in ("optimum", "vertical")
        )
        here, level = values_at(scene, best.pose), values_at(scene, upright.pose)
        more_db = power_db(scene, upright.pose, here[2]) if which == 2 else here[which] - level[which]
        start: Row = [index, len(scene.nodes), len(scene.jammers), scene.receiver.noise_w, OBJECTIVES[which]]
        number_of = best.objective
        pose = [*best.pose.position_m.tolist(), axis_of(best.pose)[0]]
        numbers = [best.status.value, number_of.value, number_of.upper_bound, *pose, *here]
        yield [*start, *numbers, upright.status.value, *level, more_db]


def write(name: str) -> None:
    """Write a table, or the rest of the fields'.

    Args:
        name: of the table.
    """
    path = FOLDER / f"objectives-{name}.csv"
    goes_on = name == "fields" and path.exists()
    done = len(path.read_text(encoding="utf-8").splitlines()) - 1 if goes_on else 0
    with path.open("a" if goes_on else "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        for count, row in enumerate(field_rows(done) if name == "fields" else paper_rows()):
            if count > 0 or not goes_on:
                writer.writerow([f"{cell:.9g}" if isinstance(cell, float) else cell for cell in row])
                file.flush()


if __name__ == "__main__":
    for table in ("fields", "paper"):
        write(table)
