"""What all tables have in common."""

import subprocess
import sys

import pytest

from nullpose.errors import ScenarioError
from nullpose.scenario import Receiver, Scenario


def test_import_is_lean() -> None:
    """Scenarios bring in no solver, no plots and no command line; places on the Earth alone their library."""
    code = (
        "import sys; from nullpose.scenario import Scenario\n"
        "heavy = {'scipy', 'numba', 'matplotlib', 'typer', 'rich', 'pymap3d'}\n"
        "data = {'airspace': {'altitude_m': [8, 30]}, 'receiver': {'noise_w': 1.0, 'frequency_hz': 1e9},\n"
        "        'origin': {'lat_deg': 1, 'lon_deg': 2, 'alt_m': 3}}\n"
        "for place in ({'position_m': [0, 0, 0]}, {'lat_deg': 1, 'lon_deg': 2, 'alt_m': 3}):\n"
        "    Scenario.from_dict(data | {'nodes': [{'power_w': 1.0} | place]})\n"
        "    print(sorted(heavy & sys.modules.keys()))\n"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ran.stdout.splitlines() == ["[]", "['pymap3d']"]


def test_very_many_unknown_keys_are_told_in_few_words() -> None:
    """The first twenty are named and the others counted; a list that is far too long is one fault."""
    with pytest.raises(ScenarioError) as caught:
        Receiver.from_dict(
            {f"k{number}": 1 for number in range(100_000)} | {"noise_w": 1.0, "frequency_hz": 1e9}
        )
    assert [fault.path for fault in caught.value.faults if fault.path] == [
        f"k{number}" for number in range(20)
    ]
    assert [fault.message for fault in caught.value.faults if not fault.path] == [
        "99980 more keys are unknown; remove them too"
    ]
    assert str(caught.value).endswith("... and 1 more")
    with pytest.raises(ScenarioError) as caught:
        Scenario.from_dict({"nodes": [1] * 10_001})
    (fault,) = caught.value.faults
    assert str(fault) == "nodes: there are more than 10000 members, the most that are allowed"
