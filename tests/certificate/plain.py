"""Builders and plain algebra that the tests of the verifier share."""

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import numpy as np
from hypothesis import strategies as st

from nullpose.certificate import Certificate, Leaves, Tree, claimed_axes, verify
from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import COLUMNS, TOWARDS, WORLD
from nullpose.certificate.channels import excess_at
from nullpose.certificate.forms import matrices
from nullpose.certificate.interval import Interval
from nullpose.certificate.pose_value import Exact, antenna_axis, exact, ratios_at, value_of
from nullpose.channel import LinkChannel, PointChannels, excess_gain
from nullpose.channel.elevation import elevation_excess
from nullpose.channel.model import BY_DISTANCE, BY_ELEVATION, WIDTH
from nullpose.channel.power_law import distance_excess
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.scenario import Scenario
from nullpose.solver import solve
from nullpose.solver.certificate_from_proof import certificate_of, leaves_of
from nullpose.solver.options import SolveOptions
from nullpose.solver.solve_and_prove import solve_and_prove

_ENOUGH_S = 600.0  # the kernels may have to be compiled first

seeds = st.integers(0, 2**32 - 1)


def value_at(family: Family, position: Exact, axis: Exact, gains: Interval | None = None) -> Fraction:
    """Return what is maximised at a pose, by the verifier's numbers."""
    return value_of(family.ratios, ratios_at(family.ratios, position, axis, gains=gains))


def accepted(certificate: Certificate) -> str:
    """Return the words with which a certificate is accepted."""
    verdict = verify(certificate)
    assert verdict.proved, verdict.message
    assert verdict.leaves == sum(len(tree.leaves) for tree in certificate.trees)
    return verdict.message


def rejected(certificate: Certificate) -> str:
    """Return the words with which a certificate is rejected."""
    verdict = verify(certificate)
    assert not verdict.proved
    assert verdict.message.startswith("rejected: ")
    return verdict.message


def with_tree(certificate: Certificate, **changes: object) -> Certificate:
    """Change the first tree of a certificate."""
    tree = replace(certificate.trees[0], **changes)
    return replace(certificate, trees=(tree, *certificate.trees[1:]))


def with_leaves(certificate: Certificate, **columns: object) -> Certificate:
    """Change columns of the first tree's leaves: to an array, or by a function."""
    leaves = certificate.trees[0].leaves
    changed = {k: each(getattr(leaves, k).copy()) if callable(each) else each for k, each in columns.items()}
    return with_tree(certificate, leaves=replace(leaves, **changed))


def full(form: Interval) -> np.ndarray:
    """Return the middle of one box's form as a matrix."""
    return matrices(form.middle())[0]


def certified(
    scenario: Scenario, scheme: str = "optimum", gap: float = 1e-3, null_jammer: str | None = None
) -> Certificate:
    """The certificate of a scenario solved under a scheme to a gap."""
    solution = solve(scenario, scheme, gap=gap, null_jammer=null_jammer, time_limit_s=_ENOUGH_S)
    return certificate_of(solution)


def put_together(scenario: Scenario, scheme: str = "optimum", gap: float = 1e-3) -> Certificate:
    """The certificate of a scenario's outcome family, its pose from axis and mount."""
    family, fields = build_family(scenario, any_channel=True), claimed_axes(scenario, scheme, None)
    assert fields is not None
    effort = SolveOptions(gap=gap, time_limit_s=_ENOUGH_S, node_limit=10**9)
    outcome = solve_and_prove(family, list(fields.values()), effort)
    mount_rad = 0.0 if scenario.airframe is None else scenario.airframe.mount_rad
    east, north, up = outcome.incumbent.axis * np.sign(outcome.incumbent.axis[2] or 1.0)
    # the body leans in the plane of vertical and dipole, by the least angle that brings it there
    lean = float(np.arctan2(np.hypot(east, north), up)) - mount_rad
    attitude = (0.0, lean, float(np.arctan2(north, east)))
    position = exact(outcome.incumbent.position_m)
    axis, gains = antenna_axis(attitude, mount_rad), excess_at(family.ratios, position)
    value = float(value_at(family, position, axis, gains=gains))
    trees = zip(fields.items(), outcome.proofs, strict=True)
    return Certificate(
        scenario=scenario,
        scheme=scheme,
        null_jammer=None,
        value=value,
        upper_bound=max(value, outcome.upper_bound or 0.0),
        position_m=outcome.incumbent.position_m,
        roll_rad=attitude[0],
        pitch_rad=attitude[1],
        yaw_rad=attitude[2],
        trees=tuple(
            Tree(axis=axis, root_m=p.root, leaves=leaves_of(p, field, family)) for (axis, field), p in trees
        ),
    )


def cut_into_cells(certificate: Certificate) -> Certificate:
    """A certificate some of whose leaves are cut into cells of axes, with multipliers.

    Each cell inherits its leaf's proof, and the sides' multipliers are as large as the proof bears.
    """
    tree = certificate.trees[0]
    leaves = tree.leaves
    chosen = np.flatnonzero(np.isin(leaves.test, (WORLD, TOWARDS)) & (leaves.face < 0))[::4]
    cells = [[0, 0, 0, 0, 0], [1, 0, 0, 1, 0], [1, 0, 0, 1, 1], [2, 1, 0, 0, 0], [2, 1, 1, 0, 0]]
    rest = np.setdiff1d(np.arange(len(leaves)), chosen)
    rows = np.concatenate([rest, np.repeat(chosen, len(cells))])
    cut_leaves = leaves.chosen(rows)
    cut_leaves.cell[len(rest) :] = np.tile(cells, (len(chosen), 1))
    for power in range(12):
        sides = np.zeros((len(rows), 2))
        sides[len(rest) :] = 4.0**-power * np.mean(leaves.level)
        cut = replace(tree, leaves=replace(cut_leaves, sides=sides))
        result = replace(certificate, trees=(cut, *certificate.trees[1:]))
        if verify(result).proved:
            return result
    raise AssertionError("no multiplier of the sides is small enough")


def random_family(
    rng: np.random.Generator,
    ratios: int,
    others: int,
    keep_out_m: float = 1.0,
    groups: int = 1,
    channel: LinkChannel | None = None,
) -> Family:
    """So many ratios over denominators of so many points each, with keep-out balls and a channel."""
    entries = groups * others
    points_m = rng.uniform([0.0, 0.0, 0.0], [60.0, 60.0, 5.0], (ratios + entries, 3))
    return Family(
        points_m=points_m,
        numerator_isotropic=rng.uniform(0.0, 0.2, ratios),
        numerator_weight=10.0 ** rng.uniform(2.0, 4.0, ratios),
        numerator_point=np.arange(ratios),
        denominator_of=np.arange(ratios) % groups,
        denominator_isotropic=rng.uniform(0.5, 2.0, groups),
        denominator_start=others * np.arange(groups + 1),
        denominator_point=ratios + np.arange(entries),
        denominator_weight=10.0 ** rng.uniform(1.0, 4.0, entries),
        low_m=np.array([-np.inf, -np.inf, 8.0]),
        high_m=np.array([np.inf, np.inf, 30.0]),
        keep_out_points_m=points_m,
        keep_out_m=keep_out_m,
        leak=float(np.choose(int(points_m[0, 0]) % 3, [0.0, 0.001, 0.3])),
        channels=np.zeros((0, WIDTH)) if channel is None else np.tile(channel.row, (len(points_m), 1)),
    )


def excess_over(family: Family, position_m: np.ndarray) -> np.ndarray:
    """The excess gains of a family's points at positions, (..., points), from the models."""
    ratios = family.ratios
    to_points_m = ratios.points_m - position_m[..., None, :]
    if not len(ratios.channels):
        return np.ones(to_points_m.shape[:-1])
    kinds = ((BY_DISTANCE, distance_excess), (BY_ELEVATION, elevation_excess))
    groups = tuple((model, np.flatnonzero(ratios.channels[:, 0] == kind)) for kind, model in kinds)
    return excess_gain(PointChannels(np.ones(len(ratios.points_m)), ratios.channels, groups), to_points_m)


def make_leaves(count: int, **columns: object) -> Leaves:
    """Leaves of which only some columns matter, one number for all or an array; others are of no effect."""
    plain = {"cell": [-1, 0, 0, 0, 0], "point": -1, "level": 1.0, "ball": -1}
    columns = {"mixes": ({0: 1.0},)} | dict.fromkeys(COLUMNS, 0) | plain | columns
    for name, (kind, shape) in COLUMNS.items():
        columns[name] = np.array(np.broadcast_to(columns[name], (count, *shape)), dtype=kind)
    return Leaves(**columns)


def link_matrix(r: np.ndarray, leak: float) -> np.ndarray:
    """The forms of links, ``(|r|^2 I - (1 - leak) r r^T) / |r|^4``, (..., 3, 3)."""
    square = np.sum(r * r, axis=-1)[..., None, None]
    return (square * np.eye(3) - (1.0 - leak) * r[..., :, None] * r[..., None, :]) / square**2


def dense_forms(family: Family, position_m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Numerator and denominator of a family's first ratio at a position, densely."""
    ratios = family.ratios
    g = ratios.denominator_of[0]
    entries = range(ratios.denominator_start[g], ratios.denominator_start[g + 1])
    links = [link_matrix(point - position_m, ratios.leak) for point in ratios.points_m]
    below = ratios.denominator_isotropic[g] * np.eye(3)
    below = below + sum(
        (ratios.denominator_weight[e] * links[ratios.denominator_point[e]] for e in entries),
        np.zeros((3, 3)),
    )
    above = ratios.numerator_isotropic[0] * np.eye(3)
    return above + ratios.numerator_weight[0] * links[ratios.numerator_point[0]], below


def dense_ratios(family: Family, position_m: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """The ratios of a family at poses, (..., ratios), by plain matrices alone."""
    ratios = family.ratios
    u = axis / np.linalg.norm(axis, axis=-1, keepdims=True)
    links = link_matrix(ratios.points_m - position_m[..., None, :], ratios.leak)
    gains = np.einsum("...i,...pij,...j->...p", u, links, u) * excess_over(family, position_m)
    entries = ratios.denominator_weight * gains[..., ratios.denominator_point]
    sums = [entries[..., a:b].sum(axis=-1) for a, b in pairwise(ratios.denominator_start)]
    below = (ratios.denominator_isotropic + np.stack(sums, axis=-1))[..., ratios.denominator_of]
    above = ratios.numerator_weight * gains[..., ratios.numerator_point]
    return (ratios.numerator_isotropic + above) / below


def boxes_at(centre: object, half: object) -> Boxes:
    """Return boxes about centres, (b, 3), of some half sides, each of a leaf of its own."""
    centre = np.asarray(centre, dtype=float)
    return Boxes(leaf=np.arange(len(centre)), centre=centre, half=half * np.ones_like(centre))


def one_box(rng: np.random.Generator) -> Boxes:
    """Return a box above the field."""
    return boxes_at(
        rng.uniform([-30.0, -30.0, 9.0], [80.0, 80.0, 30.0], (1, 3)), rng.uniform(0.05, 1.5, (1, 3))
    )


def carried(turns: bool, anchor: np.ndarray, centre: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Return the rotation that carries the frame at a centre along a straight line to p.

    The direction to a point turns in one plane along the line: the least rotation between its ends is it.
    """
    if not turns:
        return np.eye(3)
    d, e = anchor - centre, anchor - p
    d, e = d / np.linalg.norm(d), e / np.linalg.norm(e)
    axis = np.cross(d, e)
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + cross + cross @ cross / (1.0 + d @ e)


def overheard(scenario: Scenario, *places: tuple[float, float, float], power_w: float = 1.0) -> Scenario:
    """Return a scenario in which the drone transmits and somebody listens in at each place."""
    plain = scenario.to_dict()
    secrecy = {"objective": "secrecy-rate", "transmitter": {"power_w": power_w}, "jammers": []}
    nodes = [{"position_m": node["position_m"]} for node in plain["nodes"]]
    heard = [{"position_m": place} for place in places]
    return Scenario.from_dict(plain | secrecy | {"nodes": nodes, "eavesdroppers": heard})
