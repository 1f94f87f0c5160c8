"""Other engines as judges: decks, outputs and the page, without the engines."""

import numpy as np
import pytest
from benchmarks.judges import __main__ as judges, engine, ray_tracer, towns, wires
from benchmarks.judges.verdict import Verdict

from nullpose import Scenario
from nullpose.physics import Reception

GOOD = Verdict("engine 1.0", "a link", 12, 1e-6, 1e-4)
BAD = Verdict("engine 1.0", "a link", 12, 1e-3, 1e-4)
ABSENT = Verdict("engine", "a link", 0, None, 1e-4, reason="not on the path")

OUTPUT = """
                           - - - CURRENTS AND LOCATION - - -

   SEG  TAG    COORDINATES OF SEGM CENTER     SEGM    ------------- CURRENT (AMPS) -------------
   No:  No:       X         Y         Z      LENGTH     REAL      IMAGINARY    MAGN        PHASE
     1    1    0.0000    0.0000   -0.0067   0.00667  1.0000E-06 -2.0000E-06 2.2361E-06  -63.435
     2    1    0.0000    0.0000    0.0000   0.00667  1.0000E-06 -3.0000E-06 3.1623E-06  -71.565
     3    2    5.0000    0.0000    0.0000   0.00667  3.0000E-09 -4.0000E-09 5.0000E-09  -53.130
"""


def test_current_of_a_segment() -> None:
    """The magnitude is found by the wire's tag and the place in it; one that is missing is said."""
    assert wires.current(OUTPUT, 1, 2) == 3.1623e-06
    assert wires.current(OUTPUT, 2, 1) == 5e-09
    with pytest.raises(ValueError, match="no current in segment 2 of wire 2"):
        wires.current(OUTPUT, 2, 2)


def test_deck() -> None:
    """A wire has its length about its middle, and the deck feeds the segment that is asked for."""
    card = wires.wire(2, 3, np.array([1.0, 2.0, 3.0]), np.array([0.0, 0.0, 1.0]), 0.5)
    numbers = [float(x) for x in card.split()[3:9]]
    assert numbers == [1.0, 2.0, 2.75, 1.0, 2.0, 3.25]
    assert "EX 0 2 2 0 1.0 0.0" in wires.deck([card], 2, 2, ["XQ"])


@pytest.mark.parametrize(("found", "code"), [([GOOD, ABSENT], 0), ([GOOD, BAD], 1)])
def test_a_judge_that_disagrees_fails_the_command(
    found: list[Verdict], code: int, tmp_path: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The command ends with 1 if one disagrees; one that is absent is no failure."""
    monkeypatch.setattr(judges, "PAGE", tmp_path / "judges.md")  # type: ignore[operator]
    monkeypatch.setattr(wires, "verdicts", lambda: iter(found))
    monkeypatch.setattr(ray_tracer, "verdicts", lambda: iter(()))
    assert judges.main() == code


def test_without_the_engine_there_is_a_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without nec2c or LLVM each judge says what to install."""
    monkeypatch.setattr(wires.shutil, "which", lambda _: None)
    assert {verdict.deviation for verdict in wires.verdicts()} == {None}
    monkeypatch.setattr(engine, "library", lambda: None)
    (verdict,) = ray_tracer.verdicts()
    assert "libllvm19" in verdict.reason


def test_towns_have_what_the_judge_is_for() -> None:
    """A thousand links of each scene; our gains deviate by nothing, those of a scene without buildings do."""
    for _, scenario, poses in towns.towns():
        positions_m = np.array([pose.position_m for pose in poses])
        is_clear, is_near = ray_tracer.lines_of_sight(scenario, positions_m)
        assert is_clear.size == 1000
        assert 0.2 < is_clear.mean() < 0.8
        assert is_near.sum() < 5
        axes = [pose.antenna_axis for pose in poses]
        received_w = Reception(scenario, positions_m, np.array(axes)).received_w
        ours = received_w / scenario.source_powers_w
        assert max(ray_tracer.deviations(scenario, poses, ours)) < 1e-12
        assert max(ray_tracer.deviations(scenario, poses, ours / np.where(is_clear, 1.0, 1e-20))) > 1.0


@pytest.mark.parametrize(
    ("beside_m", "is_near"), [(-2e-3, False), (-5e-4, True), (5e-4, True), (2e-3, False)]
)
def test_a_link_near_an_edge_is_left_out(beside_m: float, is_near: bool) -> None:
    """Within a millimetre of a corner it may be clear for one and blocked for the other."""
    corner = {"polygon_m": [[0.0, 0.0], [5.0, 5.0], [-5.0, 5.0]], "height_m": 20.0}
    scene = Scenario.from_arrays(
        [[-50.0, beside_m, 1.0]],
        noise_w=1e-3,
        altitude_m=(1, 30),
        buildings=[corner],
        channel={"shadow_margin_m": 0.0},
    )
    found = ray_tracer.lines_of_sight(scene, np.array([[50.0, beside_m, 1.0]]))
    assert [answer.item() for answer in found] == [beside_m < 0.0, is_near]
