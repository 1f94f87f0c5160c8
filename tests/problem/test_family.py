"""The family as a value: read-only arrays and a digest of every number."""

from collections.abc import Callable

import numpy as np
import pytest

from nullpose.objectives import Ratios
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.problem.records import Domain

FIELDS = [*Ratios._fields, *Domain._fields]
ARRAYS = [name for name in FIELDS if name not in ("keep_out_m", "leak", "offset")]


@pytest.fixture(scope="module")
def family(random_problem: Callable) -> Family:
    """Returns a family of three nodes and two jammers in which every array has a number."""
    plain = build_family(random_problem(np.random.default_rng(4), 3, 2, keep_out_m=9.0))
    return plain.changed(
        turn=np.tile(np.eye(3), (len(plain.ratios.points_m), 1, 1)),
        ground_axes=np.tile([0.6, 0.0, 0.8], (len(plain.ratios.points_m), 1)),
        ground_leaks=np.full(len(plain.ratios.points_m), 0.1),
        channels=np.tile([1.0, -0.5, 1.0, 0.0, 0.0, 1.0, 0.0, 0.1], (len(plain.ratios.points_m), 1)),
        shadows_of_point=np.array([*[0] * len(plain.ratios.points_m), 1]),
        shadow_start=np.array([0, 1]),
        shadow_sides=np.array([[1.0, 0.0, 0.0, 3.0, 3.5]]),
        shares=np.array([0.2, 0.3, 0.5]),
        requirements=np.array([0.1, 0.0, 0.5]),
        pairs=np.array([[0, 1], [2, 1]]),
        piece_start=np.array([0, 1]),
        piece_sides=np.array([[1.0, 3.0, 4.0, 0.0, 2.0]]),
        zone_kind=np.array([1]),
        zone_start=np.array([0, 1]),
        zone_edges=np.array([[3.0, 4.0, 2.0, 0.0]]),
        zone_range_m=np.array([[-5.0, 60.0]]),
    )


def test_arrays_are_copies(family: Family) -> None:
    """The arrays given stay their owner's: writing to them later changes neither family nor digest."""
    weights = np.array(family.ratios.numerator_weight)
    copy = family.changed(numerator_weight=weights)
    digest = copy.digest
    weights[0] = 99.0
    assert copy.ratios.numerator_weight[0] == family.ratios.numerator_weight[0]
    assert copy.digest == digest


@pytest.mark.parametrize(("name", "given"), [("points_m", np.float32), ("numerator_point", np.int32)])
def test_kernels_get_one_type_of_number(family: Family, name: str, given: type) -> None:
    """Whatever the width of the numbers given, arrays have 64 bits: compiled code is entered unchecked."""
    array = family.fields[name]
    kept = family.changed(**{name: np.asfortranarray(array).astype(given)}).fields[name]
    assert kept.dtype == array.dtype
    assert kept.flags.c_contiguous


def test_a_family_is_frozen(family: Family) -> None:
    """No field can be replaced, and no array written to."""
    for part in (family, family.ratios, family.domain):
        for name in getattr(part, "_fields", ("ratios", "domain")):
            with pytest.raises(AttributeError):
                setattr(part, name, getattr(part, name))
    for name in ARRAYS:
        with pytest.raises(ValueError, match="read-only"):
            family.fields[name][...] = 0


@pytest.mark.parametrize("name", FIELDS)
def test_digest_sees_every_number(family: Family, name: str) -> None:
    """Changing any one number by its last digit changes the digest, to a different one each time."""
    value = np.array(family.fields[name])
    assert value.size > 0
    digests = {family.digest}
    for index in np.ndindex(value.shape):
        changed = value.copy()
        if value.dtype.kind == "i":
            changed[index] += 1
        else:
            changed[index] = np.nextafter(changed[index], 0.0) if changed[index] != 0.0 else 5e-324
        digests.add(family.changed(**{name: changed if value.shape else float(changed)}).digest)
    assert len(digests) == 1 + value.size
