"""A cell that holds a pose is not excluded below what the pose reaches."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from sizes import few_examples

from nullpose.antenna.caps import pattern_arrays
from nullpose.antenna.dipoles import half_wave_harmonics
from nullpose.antenna.harmonics import Harmonics
from nullpose.problem.family import Family
from nullpose.problem.records import AttitudeReach
from nullpose.solver.kernels.bounds.attitude import ANCHOR, CHART, FACE, HALF, WARM
from nullpose.solver.kernels.bounds.branch import BETTER, DONE
from nullpose.solver.kernels.bounds.pattern_branch import branch_pattern
from nullpose.solver.kernels.search.pattern_search import judge

ANY = AttitudeReach(np.pi, 0.0, np.array([0.0, 0.0, 1.0]), False, False)


def random_pattern(rng: np.random.Generator, degree: int) -> Harmonics:
    """Return a pattern of positive gains."""
    cosine, sine = (np.tril(rng.normal(size=(degree + 1, degree + 1))) for _ in range(2))
    sine[:, 0] = 0.0
    shape = Harmonics(cosine, sine)
    least = shape.on_grid(np.linspace(0.0, np.pi, 60), np.linspace(0.0, 2.0 * np.pi, 120)).min()
    cosine[0, 0] += 0.1 - least
    return Harmonics(cosine, sine)


PATTERNS = [random_pattern(np.random.default_rng(seed), degree) for seed, degree in ((1, 1), (2, 3), (3, 6))]
ARRAYS = [pattern_arrays(pattern) for pattern in PATTERNS]


def random_family(rng: np.random.Generator) -> Family:
    """Return two to four ratios with one or two interferers in the ground plane."""
    nodes, jammers = rng.integers(2, 5), rng.integers(1, 3)
    points = rng.uniform(-40.0, 40.0, (nodes + jammers, 3)) * [1.0, 1.0, 0.1]
    return Family(
        points_m=points,
        numerator_isotropic=np.zeros(nodes),
        numerator_weight=1000.0 * rng.uniform(0.5, 2.0, nodes),
        numerator_point=np.arange(nodes),
        denominator_of=np.zeros(nodes, dtype=np.int64),
        denominator_isotropic=np.ones(1),
        denominator_start=np.array([0, jammers]),
        denominator_point=np.arange(nodes, nodes + jammers),
        denominator_weight=1000.0 * 10.0 ** rng.uniform(-2.0, 2.0, jammers),
        low_m=np.full(3, -1e3),
        high_m=np.full(3, 1e3),
        keep_out_points_m=np.zeros((0, 3)),
        keep_out_m=1.0,
    )


def random_cell(rng: np.random.Generator, family: Family) -> np.ndarray:
    """Return a cell of any size, in any chart and on any face."""
    cell = np.zeros(WARM + len(family.ratios.numerator_point))
    cell[:3] = rng.uniform([-40.0, -40.0, 12.0], [40.0, 40.0, 40.0])
    cell[3:6] = rng.uniform([-0.7, -0.7, -3.0], [0.7, 0.7, 3.0])
    size = 10.0 ** rng.uniform(-3.0, 0.0)
    cell[HALF : HALF + 3] = 20.0 * size * rng.uniform(size=3)
    cell[HALF + 3 : HALF + 6] = size * rng.uniform(size=3)
    cell[FACE], cell[CHART] = rng.integers(6), rng.integers(3)
    cell[ANCHOR] = rng.integers(len(family.ratios.points_m))
    cell[WARM:] = 1.0 / len(family.ratios.numerator_point)
    return cell


def rotation_at(family: Family, cell: np.ndarray) -> np.ndarray:
    """Return the rotation to the world from the antenna's axes at a cell's middle: any beats nothing."""
    point, position, rotation = cell.copy(), np.empty(3), np.empty((3, 3))
    point[HALF : HALF + 6] = 0.0
    stack, problem = np.array([point] * 4), (family.ratios, family.domain, ARRAYS[0], ANY)
    code, *_ = branch_pattern(*problem, 0.0, -1.0, False, stack, 1, stack, 0, 1, position, rotation)
    assert code == BETTER
    np.testing.assert_array_equal(position, cell[:3])
    return rotation


@pytest.mark.parametrize("which", range(len(PATTERNS)))
@few_examples(20)
@given(seed=st.integers(0, 2**32 - 1))
def test_a_pose_keeps_its_cell(which: int, seed: int) -> None:
    """Whatever the cell's size, the branch and bound never empties it below the value of a pose inside."""
    rng = np.random.default_rng(seed)
    family = random_family(rng)
    cell = random_cell(rng, family)
    inside = cell.copy()
    inside[:6] += cell[HALF : HALF + 6] * rng.uniform(-1.0, 1.0, 6)
    rotation, value = rotation_at(family, inside), np.empty(1)
    state = np.append(inside[:3], rotation)
    judge(family.ratios, family.domain, ARRAYS[which], state[None], value)
    level = float(np.exp(value[0])) * (1.0 - 1e-9)
    stack = np.empty((4000, len(cell)))
    stack[0] = cell
    problem, pose = (family.ratios, family.domain, ARRAYS[which], ANY), (np.empty(3), np.empty((3, 3)))
    code, top, *_ = branch_pattern(*problem, level, np.inf, False, stack, 1, stack, 0, 400, *pose)
    assert code != DONE
    assert top > 0


LOBE = Harmonics(np.array([[1.0, 0.0], [-0.5, 0.0]]), np.zeros((2, 2)))
THIN = half_wave_harmonics()


@pytest.mark.parametrize("even", [True, False], ids=["even", "uneven"])
@few_examples(25)
@given(seed=st.integers(0, 2**32 - 1), tilt=st.floats(0.0, 1.5), share=st.floats(-1.0, 1.0))
def test_a_pose_within_reach_keeps_its_cell(even: bool, seed: int, tilt: float, share: float) -> None:
    """So it is for antennas that are the same all round, by any anchor and at the ends of the reach."""
    rng = np.random.default_rng(seed)
    family = random_family(rng)
    pattern = pattern_arrays(THIN if even else LOBE)
    cell = random_cell(rng, family)
    cell[FACE], cell[ANCHOR] = 0.0, rng.integers(-1, len(family.ratios.points_m))
    cell[CHART] *= cell[ANCHOR] >= 0
    cell[3], cell[4], cell[HALF + 4] = rng.uniform(0.0, np.pi / 2.0 if even else np.pi), 0.0, 0.0
    inside = cell.copy()
    inside[:6] += cell[HALF : HALF + 6] * rng.uniform(-1.0, 1.0, 6)
    rotation, value = rotation_at(family, inside), np.empty(1)
    angle = np.arccos(np.clip(abs(rotation[2, 2]) if even else rotation[2, 2], -1.0, 1.0))
    mount = np.clip(angle + share * tilt, 0.0, np.pi / 2.0 if even else np.pi)
    reach = AttitudeReach(tilt, mount, np.array([-np.sin(mount), 0.0, np.cos(mount)]), True, even)
    judge(family.ratios, family.domain, pattern, np.append(inside[:3], rotation)[None], value)
    level = float(np.exp(value[0])) * (1.0 - 1e-9)
    stack = np.empty((4000, len(cell)))
    stack[0] = cell
    problem, pose = (family.ratios, family.domain, pattern, reach), (np.empty(3), np.empty((3, 3)))
    code, top, *_ = branch_pattern(*problem, level, np.inf, False, stack, 1, stack, 0, 400, *pose)
    assert code != DONE
    assert top > 0


def test_rotations_are_rotations() -> None:
    """A cell's middle is a rotation, and the anchor is seen where u and v say."""
    rng = np.random.default_rng(5)
    family = random_family(rng)
    for _ in range(50):
        cell = random_cell(rng, family)
        rotation = rotation_at(family, cell)
        np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(rotation) == pytest.approx(1.0)
        way = family.ratios.points_m[int(cell[ANCHOR])] - cell[:3]
        seen = rotation.T @ way / np.linalg.norm(way)
        u, v = cell[3:5]
        there = np.array([np.sin(u) * np.cos(v), -np.sin(v), np.cos(u) * np.cos(v)])
        assert np.sort(np.abs(seen)) == pytest.approx(np.sort(np.abs(there)))
