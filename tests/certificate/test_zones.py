"""Zones in boxes: every allowed position of a box meets an alternative that names it."""

from collections.abc import Callable

import numpy as np
from hypothesis import given
from sizes import few_examples
from tests.certificate.plain import boxes_at, seeds

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.taylor import Taylor
from nullpose.certificate.zones import forbidden, zone_alternatives
from nullpose.errors import ScenarioError
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.scenario import Airspace

ALTITUDES = {"altitude_m": (8.0, 30.0)}


def random_airspace(rng: np.random.Generator) -> Airspace:
    """Return an airspace with zones of each kind and a fence, far enough from simple."""
    while True:
        count = int(rng.integers(3, 8))
        angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, count))
        vertices = rng.uniform(5.0, 20.0, (count, 1)) * np.column_stack([np.cos(angles), np.sin(angles)])
        whole = bool(rng.integers(2))
        fence = 3.0 * np.roll(vertices, 1, axis=1)
        bottom, top = np.sort(rng.choice([0.0, 10.0, 19.0, 25.0, 40.0], 2, replace=False))
        zones = [
            {"polygon_m": (np.round(vertices) if whole else vertices).tolist(), "altitude_m": (bottom, top)},
            {"centre_m": tuple(rng.uniform(-20.0, 20.0, 2)), "radius_m": float(rng.uniform(3.0, 15.0))},
            {"x_m": (-5.0, float(rng.uniform(0.0, 9.0))), "y_m": (4.0, 24.0), "altitude_m": (9.0, 12.0)},
        ]
        try:
            geofence = (np.round(fence) if whole else fence).tolist()
            return Airspace(geofence_m=geofence, no_fly=zones, **ALTITUDES)
        except ScenarioError:  # edges that cross, vertices that meet
            continue


def family_of(airspace: Airspace, paper: Callable) -> Family:
    """Return a family with an airspace's zones."""
    return build_family(paper().model_copy(update={"airspace": airspace}))


def some_boxes(rng: np.random.Generator, family: Family, count: int) -> Boxes:
    """Return boxes, most of them near an edge of some zone, some with ends at whole numbers."""
    at = family.domain.zone_edges[rng.integers(len(family.domain.zone_edges), size=count)]
    share = rng.choice([0.0, 0.5, 1.0], (count, 1)) * rng.uniform(0.9, 1.1, (count, 1))
    on_edge = at[:, :2] + share * (at[:, 2:] - at[:, :2])
    centre = np.column_stack([on_edge, rng.choice([8.5, 9.0, 10.0, 15.0, 25.0, 29.0], count)])
    half = 10.0 ** rng.uniform(-3.0, 0.9, (count, 3))
    centre = centre + rng.uniform(-1.0, 1.0, (count, 3)) * half
    whole = rng.integers(0, 3, count) == 0
    low, high = np.floor(centre - half), np.ceil(centre + half)
    centre = np.where(whole[:, None], 0.5 * (low + high), centre)
    half = np.where(whole[:, None], 0.5 * (high - low), half)
    return boxes_at(centre, half)


def value_at(bound: Taylor, i: int, shift: np.ndarray) -> float:
    """Return an upper bound on a function at a position of the i-th of its boxes."""
    value, slopes, bends = (part.high[..., min(i, part.high.shape[-1] - 1)] for part in bound.at)
    return float(value + slopes @ shift + 0.5 * bends[:3] @ shift**2)


@few_examples(15)
@given(seed=seeds)
def test_allowed_positions_meet_an_alternative(seed: int, paper: Callable) -> None:
    """Whatever the zone: what it allows meets all constraints of an alternative."""
    rng = np.random.default_rng(seed)
    airspace = random_airspace(rng)
    family = family_of(airspace, paper)
    count = 40
    boxes = some_boxes(rng, family, count)
    zone = rng.integers(len(family.domain.zone_kind), size=count)
    found = zone_alternatives(family.domain, zone, boxes)
    never = forbidden(family.domain, zone, boxes)
    assert np.array_equal(never, ~np.isin(np.arange(count), np.concatenate([rows for rows, _ in found])))
    for b in range(count):
        shifts = rng.uniform(-1.0, 1.0, (12, 3))
        shifts[:6] = np.sign(shifts[:6])
        for shift in shifts * boxes.half[b]:
            if not allows(family, int(zone[b]), boxes.centre[b] + shift):
                continue
            assert not never[b]
            assert any(
                all(value_at(bound, i, shift) >= -1e-9 for bound in bounds)
                for rows, bounds in found
                for i in np.flatnonzero(rows == b)
            )


def allows(family: Family, zone: int, p: np.ndarray) -> bool:
    """Return whether a zone allows a position, plainly; just inside it counts as forbidden."""
    low, high = family.domain.zone_range_m[zone]
    edges = family.domain.zone_edges[family.domain.zone_start[zone] : family.domain.zone_start[zone + 1]]
    if p[2] <= low or p[2] >= high:
        return True
    if family.domain.zone_kind[zone] == 1:
        return bool(np.hypot(*(p[:2] - edges[0, :2])) >= edges[0, 2])
    first, last = edges[:, :2] - p[:2], edges[:, 2:] - p[:2]
    across = first[:, 0] * last[:, 1] - first[:, 1] * last[:, 0]
    turned = np.sum(np.arctan2(across, np.sum(first * last, axis=1)))
    return bool(abs(turned) > np.pi) == (family.domain.zone_kind[zone] == 2)


def test_boxes_inside_a_zone_are_forbidden(paper: Callable) -> None:
    """Each kind forbids boxes inside it and not those that reach a border, however little."""
    airspace = Airspace(
        no_fly=[
            {"x_m": (0.0, 10.0), "y_m": (0.0, 10.0), "altitude_m": (9.0, 20.0)},
            {"centre_m": (30.0, 0.0), "radius_m": 5.0},
        ],
        geofence_m=[(-50.0, -50.0), (50.0, -50.0), (50.0, 50.0), (-50.0, 50.0)],
        **ALTITUDES,
    )
    family = family_of(airspace, paper)
    inside = [
        (0, (5.0, 5.0, 15.0), (4.9, 4.9, 4.9)),
        (1, (30.0, 0.0, 15.0), (3.5, 3.5, 100.0)),
        (2, (60.0, 0.0, 15.0), (9.9, 100.0, 100.0)),
    ]
    reaching = [
        (0, (5.0, 5.0, 15.0), (5.0, 4.9, 4.9)),
        (0, (5.0, 5.0, 15.0), (4.9, 4.9, 5.0)),
        (0, (5.0, 5.0, 14.0), (4.9, 4.9, 5.0)),
        (0, (25.0, 5.0, 14.0), (4.9, 4.9, 5.0)),
        (1, (30.0, 0.0, 15.0), (3.6, 3.6, 1.0)),
        (1, (30.0, 0.0, 15.0), (5.0, 0.0, 1.0)),
        (2, (60.0, 0.0, 15.0), (10.0, 1.0, 1.0)),
        (2, (0.0, 0.0, 15.0), (10.0, 1.0, 1.0)),
    ]
    for cases, expected in ((inside, True), (reaching, False)):
        zone = np.array([case[0] for case in cases])
        boxes = boxes_at(np.array([case[1] for case in cases]), np.array([case[2] for case in cases]))
        assert np.all(forbidden(family.domain, zone, boxes) == expected)
