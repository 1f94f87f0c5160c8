"""The vehicles that are compared."""

import pytest

from nullpose import Airframe, Array, Scenario, load
from nullpose.study import AIRFRAME_CASES, cases_of
from nullpose.study.case import SHARE, Case
from scenes import EXAMPLES

LEVELS = ("level", "tilt-10", "tilt-20", "tilt-30")
DIPOLES = [f"{level}-{dipole}" for level in LEVELS for dipole in ("vertical", "horizontal")] + [
    "omnidirectional"
]


def names(scenario: Scenario) -> list[str]:
    """Returns the names of the vehicles tried for a scenario."""
    return [case.name for case in cases_of(scenario)]


def test_dipoles_come_by_the_tilt_that_they_take(paper: Scenario) -> None:
    """From level to omnidirectional, then arrays of 2, 4 and 8."""
    assert [case.name for case in AIRFRAME_CASES] == DIPOLES
    tilts = [case.airframe.tilt_max_rad for case in AIRFRAME_CASES]
    assert tilts == sorted(tilts)
    assert names(paper) == [*DIPOLES, "array-2-digital", "array-4-digital", "array-8-digital"]


@pytest.mark.parametrize(("dipole", "mount_deg", "end"), [("vertical", 0.0, 1.0), ("horizontal", 90.0, 0.0)])
def test_each_mount_has_the_same_tilts(dipole: str, mount_deg: float, end: float) -> None:
    """Upright or flat, each dipole is tried at each tilt, and reaches more the more its vehicle tilts."""
    airframes = [case.airframe for case in AIRFRAME_CASES if case.name.endswith(f"-{dipole}")]
    assert [each.tilt_max_deg for each in airframes] == [0.0, 10.0, 20.0, 30.0]
    assert {each.mount_deg for each in airframes} == {mount_deg}
    widths = [high - low for low, high in (each.axis_band for each in airframes)]
    assert widths == sorted(set(widths))
    assert all(end in each.axis_band for each in airframes)


def test_own_airframe_joins_by_its_tilt(paper: Scenario) -> None:
    """One that is none of the others stands where its tilt puts it; one with the same axes is left out."""
    own = paper.model_copy(update={"airframe": Airframe(tilt_max_deg=15.0, mount_deg=45.0)})
    after = DIPOLES.index("tilt-10-horizontal") + 1
    assert names(own)[: len(DIPOLES) + 1] == [*DIPOLES[:after], "stated", *DIPOLES[after:]]
    same = paper.model_copy(update={"airframe": Airframe(tilt_max_deg=90.0, mount_deg=0.0)})
    assert names(same) == names(paper)


def test_own_array_sets_layout_and_spacing(paper: Scenario) -> None:
    """Layout and spacing of the file's array hold for all sizes, and its own size is tried as well."""
    own = paper.model_copy(update={"array": Array(elements=3, layout="circular", spacing_wavelengths=0.4)})
    arrays = [case.array for case in cases_of(own) if case.array is not None]
    assert sorted({array.elements for array in arrays}) == [2, 3, 4, 8]
    assert {(array.layout, array.spacing_wavelengths) for array in arrays} == {("circular", 0.4)}


@pytest.mark.parametrize("case", AIRFRAME_CASES, ids=DIPOLES)
def test_a_case_replaces_vehicle_and_array(paper: Scenario, case) -> None:
    """The scenario with a vehicle has that airframe and no array, and is otherwise the same."""
    own = paper.model_copy(update={"array": Array(elements=3, layout="linear", spacing_wavelengths=0.5)})
    varied = case.on(own)
    assert (varied.airframe, varied.array) == (case.airframe, None)
    assert varied.model_copy(update={"airframe": None}) == paper


def test_arrays_are_compared_with_the_papers_antennas_only() -> None:
    """With other antennas, another channel or a secrecy rate there is no array beside the dipoles."""
    assert names(load(EXAMPLES / "eavesdropper.toml")) == DIPOLES
    data = load(EXAMPLES / "paper.toml").to_dict()
    assert any(case.array for case in cases_of(Scenario.from_dict(data)))
    leaking = data | {"antenna": {"null_depth_db": 30.0}}
    circular = data | {"nodes": [node | {"antenna": "circular"} for node in data["nodes"]]}
    urban = data | {"channel": {"model": "power-law", "exponent": 2.5}}
    for other in (leaking, circular, urban):
        assert not any(case.array for case in cases_of(Scenario.from_dict(other)))


def test_a_case_may_state_the_least_tilt_and_the_best_mount() -> None:
    """Both words become numbers of one airframe, to be found, beside the shares and counts that find them."""
    case = Case.from_dict({"airframe": {"tilt_max_deg": "least", "mount_deg": "best"}})
    assert case.airframe == Airframe(tilt_max_deg=180.0, mount_deg=0.0)
    assert (case.reach, case.mount_scenes) == (SHARE, 64)
