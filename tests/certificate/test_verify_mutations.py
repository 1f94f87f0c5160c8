"""A certificate spoiled anywhere is rejected: each mutation is judged by plain sampling before."""

import json
import math
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from benchmarks.mutations.changes import CLASSES, forged, spoiled
from benchmarks.mutations.truth import Data
from sizes import chosen
from tests.certificate.judge import Judge
from tests.certificate.plain import certified, cut_into_cells, rejected, with_leaves, with_tree

from nullpose.certificate import Certificate, certificate_text, parse_certificate, verify
from nullpose.certificate.certificate import KEPT_OUT
from nullpose.errors import CertificateError, ScenarioError
from nullpose.scenario import Airframe, Airspace, Eavesdropper, Receiver, Scenario, Transmitter
from nullpose.scenario.channel import Channel


def rejection(data: Data) -> str:
    """Return the words with which a certificate is refused or rejected; none if it is accepted."""
    try:
        verdict = verify(parse_certificate(json.dumps(data)))
    except (CertificateError, ScenarioError) as error:
        return str(error)
    assert verdict.message.startswith("proved: " if verdict.proved else "rejected: ")
    return "" if verdict.proved else verdict.message.removeprefix("rejected: ")


def without_top(certificate: Certificate) -> Certificate:
    """Return a certificate whose cells on top of the cube of axes are out of reach, as they are if level."""
    top = certificate.trees[0].leaves.face == 2
    out = {
        name: lambda x, v=value: np.where(top, v, x)
        for name, value in (("test", 5), ("point", -1), ("mix", -1))
    }
    return with_leaves(certificate, **out)


def renewed(scenario: Scenario, **parts: Any) -> Scenario:
    """Return a scenario with other parts, validated."""
    return Scenario(**({name: getattr(scenario, name) for name in Scenario.model_fields} | parts))


@pytest.fixture(scope="module")
def sound(paper: Callable, scene: Callable) -> dict[str, Certificate]:
    """Returns small certificates of all kinds."""
    three = scene([(0, 0, 0), (40, 5, 2), (10, 40, 1)], [(17, 15, 4), (30, 30, 0)])
    square = {"x_m": (-20.0, 30.0), "y_m": (5.0, 60.0)}
    zones = Airspace(
        altitude_m=(8.0, 30.0),
        geofence_m=[(-20.0, -5.0), (40.0, -5.0), (10.0, 25.0), (40.0, 60.0), (-20.0, 60.0)],
        no_fly=[
            {"centre_m": (-2.0, 24.0), "radius_m": 5.0, "altitude_m": (0.0, 12.0)},
            {"polygon_m": [(-20.0, 10.0), (-6.0, 12.0), (-9.0, 20.0), (-6.0, 35.0), (-20.0, 40.0)]},
        ],
    )
    heard = {
        "objective": "secrecy-rate",
        "transmitter": Transmitter(power_w=1.0),
        "eavesdroppers": (Eavesdropper(position_m=(17, 15, 4)), Eavesdropper(position_m=(-30, 20, 0))),
        "nodes": tuple(node.model_copy(update={"power_w": None}) for node in paper().nodes),
        "jammers": (),
    }
    weights = tuple(
        node.model_copy(update={"weight": w}) for node, w in zip(paper().nodes, (0.5, 2.0), strict=True)
    )
    city = Channel(model="elevation", average="power", a=4.88, b=0.43, los_loss_db=0.1, nlos_loss_db=21.0)
    law = {
        "channel": Channel(model="power-law", exponent=3.0),
        "receiver": Receiver(noise_w=4e-5, reference_gain_db=0.0),
    }
    level, belt = Airframe(preset="level", mount_deg=90.0), Airframe(tilt_max_deg=20.0, mount_deg=30.0)
    return {
        "optimum": certified(paper(10.0), gap=0.2),
        "cells": cut_into_cells(certified(paper(0.1), gap=0.2)),
        "ball": certified(paper(keep_out_m=26.5), gap=0.02),
        "vertical": certified(paper(), "vertical", gap=0.4),
        "broadside": certified(paper(**square), "maximum-gain", gap=0.4),
        "null": certified(three, "zero-interference", gap=0.4),
        "belt": certified(renewed(paper(10.0), airframe=belt), gap=0.1),
        "level": without_top(cut_into_cells(certified(renewed(paper(0.1), airframe=level), gap=0.2))),
        "zones": certified(renewed(paper(), airspace=zones), gap=0.02),
        "secret": certified(renewed(paper(), **heard), gap=0.05),
        "weights": certified(renewed(paper(**square), nodes=weights), gap=0.1),
        "law": certified(renewed(paper(), **law), gap=0.2),
        "city": certified(renewed(paper(**square), channel=city), gap=0.5),
        "city, vertical": certified(renewed(paper(**square), channel=city), "vertical", gap=1.0),
    }


STRUCK = {
    "value",
    "hole",
    "multipliers",
    "distance",
    "root",
    "digest",
    "bound below the optimum",
    "tilt",
    "reach",
}
STRUCK |= {"pose outside"}


@pytest.mark.parametrize("wanted", chosen([100, 600], [0]))
def test_false_certificates_are_rejected(sound: dict[str, Certificate], wanted: int) -> None:
    """Hundreds of random changes that make a statement false are each rejected, with a reason."""
    rng = np.random.default_rng(2026)
    bases = {name: json.loads(certificate_text(one)) for name, one in sound.items()}
    judges = {name: Judge(data, rng) for name, data in bases.items()}
    for name, data in bases.items():
        assert judges[name].falsehood(data) == "", name
        assert rejection(data) == "", name
    best_for = {
        "cell": ("cells", "level"),
        "sides": ("cells", "level"),
        "band": ("belt",),
        "test": ("ball", "zones", "belt", "level"),
        "point": ("ball", "zones", "null", "secret"),
        "ball": ("ball", "zones"),
        "ball_multiplier": ("ball",),
        "airframe, claim redone": ("belt", "level"),
        "no_fly, claim redone": ("zones",),
        "channel, claim redone": ("law", "city", "city, vertical"),
    }
    found: Counter[str] = Counter()
    struck: Counter[str] = Counter()
    accepted = []
    turn = 0
    while sum(found.values()) < wanted:
        kind = CLASSES[turn % len(CLASSES)]
        turn += 1
        assert turn < 10 * wanted
        name = str(rng.choice(best_for.get(kind, tuple(bases))))
        data = spoiled(bases[name], kind, rng)
        if data is not None and kind.endswith("claim redone"):
            data = forged(data)
        falsehood = "" if data is None else judges[name].falsehood(data)
        if not falsehood:
            continue
        found[kind] += 1
        struck[falsehood] += 1
        if not rejection(data):
            accepted.append((name, kind, falsehood))
    assert accepted == []
    # the first is for profiles; few changes of the second are read and make anything false
    missed = (
        set(CLASSES) - {"antenna, claim redone", "channel, claim redone"} - set(found),
        STRUCK - set(struck),
    )
    assert missed == (set(), set()) if wanted == 600 else max(map(len, missed)) < 8


def test_leaves_are_needed_one_and_all(sound: dict[str, Certificate]) -> None:
    """Without any one leaf, or with its level far too low, the rest is rejected."""
    for one in (sound["cells"], sound["null"]):
        leaves, rng = one.trees[0].leaves, np.random.default_rng(5)
        for row in rng.choice(len(leaves), size=min(6, len(leaves)), replace=False):
            kept = leaves.chosen(np.delete(np.arange(len(leaves)), row))
            assert "do not cover" in rejected(with_tree(one, leaves=kept))
            low = np.where(np.arange(len(leaves)) == row, 1e-9, 1.0) * leaves.level
            if leaves.test[row] != KEPT_OUT:
                assert f"leaf {row} " in rejected(with_leaves(one, level=low))


def test_a_leaf_is_kept_out_only_where_it_is(sound: dict[str, Certificate]) -> None:
    """Each leaf that says so of a box that sticks out of the ball is rejected."""
    one = sound["ball"]
    ball_m, root_m = one.scenario.airspace.keep_out_m, one.trees[0].root_m
    point_m = one.scenario.node_positions_m[0]
    leaves = one.trees[0].leaves
    share = 2.0 ** -leaves.box[:, ::2]
    low_m = root_m[0] + (root_m[1] - root_m[0]) * leaves.box[:, 1::2] * share
    high_m = low_m + (root_m[1] - root_m[0]) * share
    farthest_m = np.linalg.norm(np.maximum(abs(low_m - point_m), abs(high_m - point_m)), axis=1)
    sticking_out = np.flatnonzero(farthest_m > ball_m * (1.0 + 1e-9))
    assert len(sticking_out) >= 10
    for row in sticking_out[::3]:
        test, point = leaves.test.copy(), leaves.point.copy()
        test[row], point[row] = KEPT_OUT, 0
        assert rejected(with_leaves(one, test=test, point=point))


def test_a_bound_that_is_too_low_is_rejected(sound: dict[str, Certificate]) -> None:
    """With bound and levels lowered together to just below the value, some leaf fails."""
    for one in sound.values():
        bound = one.value * (1.0 + 1e-9)
        trees = tuple(
            replace(t, leaves=replace(t.leaves, level=np.minimum(t.leaves.level, bound))) for t in one.trees
        )
        verdict = verify(replace(one, upper_bound=bound, trees=trees))
        assert not verdict.proved
        assert "is not excluded" in verdict.message or "root" in verdict.message


def test_undefined_numbers_prove_nothing(sound: dict[str, Certificate]) -> None:
    """Numbers that no file can hold, but a program could put in, do not slip through."""
    one = sound["ball"]
    for bad in (math.nan, math.inf):
        for field in ("value", "upper_bound"):
            rejected(replace(one, **{field: bad}))
        for name in ("level", "ball_multiplier"):
            rejected(with_leaves(one, **{name: np.full(len(one.trees[0].leaves), bad)}))
        root_m = one.trees[0].root_m.copy()
        root_m[0, 0] = bad
        rejected(with_tree(one, root_m=root_m))
