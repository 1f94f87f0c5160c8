"""Notices: on standard error, and only when there is something to wait for."""

import pytest

from nullpose.cli.output import compiling_announced


def test_compiling_is_announced_once(capsys: pytest.CaptureFixture[str]) -> None:
    """Compilations inside the block are announced once, on standard error; none, not at all."""
    import numba

    with compiling_announced():
        pass
    assert capsys.readouterr() == ("", "")
    with compiling_announced():
        for increment in (1, 2):
            numba.njit(lambda x, step=increment: x + step)(1)
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("Compiling kernels for this machine")
    assert err.count("\n") == 1
