"""Other engines as judges: decks, outputs and the page, without the engines."""

import numpy as np
import pytest
from benchmarks.judges import __main__ as judges, ray_tracer, wires
from benchmarks.judges.verdict import Verdict

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
    monkeypatch.setattr(ray_tracer, "library", lambda: None)
    (verdict,) = ray_tracer.verdicts()
    assert "libllvm19" in verdict.reason
