"""The list of cold starts; the starts themselves take minutes."""

import pytest

pytest.importorskip("pandas")

from benchmarks.cold_starts import commands


def test_every_scene_starts_cold() -> None:
    """Scenes are listed, studies are not, and the robust one is solved robustly too."""
    listed = [" ".join(arguments) for arguments in commands([])]
    assert "solve examples/paper.toml" in listed
    assert "solve examples/robust.toml --robust" in listed
    assert not any("study" in each for each in listed)
    assert commands(["whips"]) == [["solve", "examples/whips.toml"]]
