"""A spec file is read whole, with every fault at once, each by its path."""

import re
import shutil
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from nullpose import ScenarioError
from nullpose.scenario.toml_file import toml_text
from nullpose.study import AIRFRAME_CASES, Case
from nullpose.study.monte_carlo import StudySpec, draw_scene, load_spec

Tables = Callable[..., dict[str, Any]]

EXAMPLE = Path(__file__).parents[3] / "examples" / "study.toml"

CRAMPED = {"altitude_m": [1, 2], "keep_out_m": 900.0, "x_m": [0, 1], "y_m": [0, 1]}
SPACED = {"from": 1, "to": 2, "points": 2}

FAULTY = """
seed = -1
scenes = 2.5
gapp = 1e-3
[scene]
[scene.airspace]
altitude_m = [30.0, 8.0]
[nodes]
layout = "disk"
count = [5, 2]
power_w = { uniform = [2.0, 1.0] }
[jammers]
layout = "poisson"
count = 3
power_w = -1.0
height_m = { normal = [0.0] }
[[cases]]
scheme = "best"
[[cases]]
airframe = "tilt-20"
robust = "yes"
[sweep]
"jammers.M.power_w" = { from = 1.0, to = 1.0, points = 1 }
"receiver.noise_w" = []
"""


def _load(folder: Path, text: str) -> StudySpec:
    path = folder / "spec.toml"
    path.write_text(text, encoding="utf-8")
    return load_spec(path)


def _faults(folder: Path, text: str) -> dict[str, str]:
    with pytest.raises(ScenarioError) as caught:
        _load(folder, text)
    assert caught.value.source == str(folder / "spec.toml")
    return {fault.path: fault.message for fault in caught.value.faults}


def test_the_example_is_what_it_says() -> None:
    """2000 scenes, five vehicles, four powers, and scenes that differ in the jammer's place alone."""
    spec = load_spec(EXAMPLE)
    assert (spec.n_scenes, spec.gap, len(spec.points), len(spec.cases)) == (2000, 1e-3, 4, 5)
    usual = [case.airframe for case in AIRFRAME_CASES]
    assert all(case.airframe in usual for case in spec.cases)
    assert spec.sweep == (("jammers.M.power_w", (0.1, 1.0, 10.0, 100.0)),)
    one, other = draw_scene(spec, 0), draw_scene(spec, 1)
    assert one.nodes == other.nodes
    assert one.jammers[0].position_m[2] == other.jammers[0].position_m[2] == 4.0
    assert one.jammers[0].position_m != other.jammers[0].position_m


def test_every_fault_at_once(tmp_path: Path) -> None:
    """Each has its path, what was given and what is allowed."""
    faults = _faults(tmp_path, FAULTY)
    assert set(faults) == {
        "seed",
        "scenes",
        "gapp",
        "scene.airspace.altitude_m",
        "scene.receiver",
        "nodes.layout",
        "nodes.count",
        "nodes.power_w.uniform",
        "jammers",
        "jammers.count",
        "jammers.density_per_m2",
        "jammers.power_w",
        "jammers.height_m.normal",
        "cases[0].scheme",
        "cases[1].airframe",
        "cases[1].robust",
        'sweep."jammers.M.power_w"',
        'sweep."receiver.noise_w"',
    }
    assert 'did you mean "disc"' in faults["nodes.layout"]
    assert (
        'did you mean "tilt-10-horizontal"' in faults["cases[1].airframe"]
        or "tilt-30-horizontal" in faults["cases[1].airframe"]
    )
    assert 'did you mean "gap"' in faults["gapp"]
    assert "centre_m and radius_m nor x_m and y_m" in faults["jammers"]


def test_analogue_combining_is_refused() -> None:
    """A case of before that asks for it is told what arrays have; digital combining may be stated."""
    case = {"array": {"elements": 2, "layout": "linear", "spacing_wavelengths": 0.5, "combining": "digital"}}
    assert Case.from_dict(case).array.elements == 2
    case["array"]["combining"] = "analogue"
    with pytest.raises(ScenarioError, match=r"array\.combining.*digital combining, which nullpose solves"):
        Case.from_dict(case)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    """The spec, or a scenario that it names: the nearest is suggested."""
    with pytest.raises(ScenarioError, match="there is no such file"):
        load_spec(tmp_path / "none.toml")
    with pytest.raises(ScenarioError, match=r"did you mean .*study\.toml"):
        load_spec(EXAMPLE.with_name("studi.toml"))
    faults = _faults(tmp_path, 'scenes = 1\nseed = -3\n[scene]\nfile = "none.toml"\n')
    assert set(faults) == {"none.toml", "seed"}


def test_faults_of_a_named_scenario_are_told(tmp_path: Path) -> None:
    """With the file's name before their place."""
    (tmp_path / "scene.toml").write_text("[airspace]\naltitude_m = 3\n", encoding="utf-8")
    faults = _faults(tmp_path, 'scenes = 1\n[scene]\nfile = "scene.toml"\n')
    assert "scene.toml: airspace.altitude_m" in faults
    assert "scene.toml: receiver" in faults


def test_no_toml(tmp_path: Path) -> None:
    """A file that is no TOML is told with the line."""
    assert "line 1, column 9" in _faults(tmp_path, "scenes =\n")


@pytest.mark.parametrize(
    ("changes", "path", "message"),
    [
        ({"sweep": {"jammers.N.power_w": [1.0]}}, 'sweep."jammers.N.power_w"', "got N, must be one of"),
        ({"sweep": {"nodes.count": [2.5]}}, 'sweep."nodes.count"', "whole number"),
        ({"sweep": {"jammers.M.power_w": [1.0, -1.0]}}, 'sweep."jammers.M.power_w"', r"\(at -1\)"),
        ({"cases": [{"robust": True}]}, "cases[0]", "state no errors"),
        ({"cases": [{}, {"scheme": "vertical", "airframe": "level-horizontal"}]}, "cases[1]", "not reach"),
        ({"scene__airspace": CRAMPED}, "scene 0: airspace", "no room"),
        ({"cases": [{"name": "a"}, {"name": "a"}]}, "cases[1].name", "may be used once"),
        ({"cases": [{"scheme": "optimum", "robust": True}]}, "cases[0]", "both scheme and robust"),
        ({"cases": [{"pose": {"position_m": [0, 0, 9]}, "gap": 0.1}]}, "cases[0].gap", "no meaning"),
        ({"jammers__power_w": {"normal": [1.0, 0.1]}}, "jammers.power_w.normal", "_dbm"),
        ({"jammers__power_w": {"uniform": [-1.0, 0.1]}}, "jammers.power_w.uniform", "from 1e-30"),
        ({"jammers__power_w": {"uniform": [1, 2], "fixed": 1.0}}, "jammers.power_w", "exactly one"),
        ({"jammers__power_w": {"log_uniform": [0, 2]}}, "jammers.power_w.log_uniform", "above 0"),
        ({"jammers__power_w": None}, "jammers", "neither power_w nor power_dbm"),
        ({"jammers__radius_m": None}, "jammers.radius_m", 'layout "disc" needs it'),
        ({"jammers__spread_m": 2.0}, "jammers.spread_m", 'no meaning with layout "disc"'),
        ({"scenes": None}, "scenes", "how many scenes"),
        ({"sweep": {"jammers.M.power_w": {"from": 1, "to": 2}}}, 'sweep."jammers.M.power_w"', "points miss"),
        ({"sweep": {"receiver.noise_w": SPACED | {"spacing": "lgo"}}}, 'sweep."receiver.noise_w"', "log"),
        ({"sweep": {"jammers.M.power_w": [1.0, 1.0]}}, 'sweep."jammers.M.power_w"', "given twice"),
    ],
)  # fmt: skip
def test_what_does_not_fit(
    tmp_path: Path, tables: Tables, changes: dict[str, Any], path: str, message: str
) -> None:
    """What each part allows by itself but not with the others is found before anything is solved."""
    faults = _faults(tmp_path, toml_text(tables(**changes)).replace("= True", "= true"))
    assert path in faults, faults
    assert re.search(message, faults[path])


def test_files_are_scenes(tmp_path: Path, tables: Tables) -> None:
    """Without a number there is one scene for each file, and what they hold is kept with the spec."""
    for name in ("a", "b", "c"):
        spec = StudySpec.from_dict(tables(seed=ord(name)))
        (tmp_path / f"{name}.toml").write_text(draw_scene(spec, 0).to_toml(), encoding="utf-8")
    spec = _load(tmp_path, '[scene]\nfiles = ["a.toml", "b.toml", "c.toml"]\n')
    assert spec.n_scenes == 3
    assert len({draw_scene(spec, index).node_positions_m.tobytes() for index in range(3)}) == 3
    for name in ("a", "b", "c"):
        (tmp_path / f"{name}.toml").unlink()
    assert StudySpec.from_dict(spec.to_dict()) == spec


def test_plain_data_and_back(tables: Tables) -> None:
    """A spec written as plain data is read as an equal one, with the same hash."""
    changes: dict[str, Any] = {
        "cases": [
            {"airframe": "tilt-10-horizontal"},
            {"array": {"elements": 2, "layout": "linear", "spacing_wavelengths": 0.5}},
            {"pose": {"position_m": [0, 0, 9]}},
        ],
        "sweep": {"nodes.count": [1, 2], "jammers.M.power_w": {"from": 1, "to": 4, "points": 3}},
    }
    spec = StudySpec.from_dict(tables(**changes))
    again = StudySpec.from_dict(tomllib.loads(toml_text(spec.to_dict())))
    assert again == spec
    assert again.digest == spec.digest
    assert len(spec.points) == 6
    assert spec.points[1] == {"nodes.count": 1.0, "jammers.M.power_w": 2.5}
    assert StudySpec.from_dict(tables()).digest != spec.digest
    assert spec.case_names == ("C1", "C2", "C3")


def test_a_path_needs_no_quotes(tables: Tables) -> None:
    """A bare path in a file comes as tables within tables, and means the same."""
    bare = tables(sweep={"jammers": {"M": {"power_w": [1.0, 2.0]}, "radius_m": SPACED}})
    quoted = tables(sweep={"jammers.M.power_w": [1.0, 2.0], "jammers.radius_m": [1.0, 2.0]})
    assert StudySpec.from_dict(bare) == StudySpec.from_dict(quoted)


def test_scenarios_from_elsewhere_are_refused(tmp_path: Path) -> None:
    """A spec names files in its folder or below, and these likewise, unless it is allowed to."""
    (tmp_path / "inner").mkdir()
    shutil.copy(EXAMPLE.with_name("paper.toml"), tmp_path)
    spec = 'scenes = 1\n[scene]\nfile = "../paper.toml"\n'
    faults = _faults(tmp_path / "inner", spec)
    assert "outside the folder of the file that names it" in faults["../paper.toml"]
    assert load_spec(tmp_path / "inner" / "spec.toml", allow_outside=True).n_scenes == 1


@pytest.mark.parametrize(
    ("nodes", "words"),
    [
        ('layout = "poisson"\ndensity_per_m2 = 1e6', "means 4e+20 points, at most 10000"),
        ('layout = "clusters"\nparents = 10000\ncount = 10000\nspread_m = 1.0', "means 1e+08 points"),
    ],
)
def test_more_points_than_memory_holds(nodes: str, words: str, tmp_path: Path) -> None:
    """How many points a layout means is looked at before they are drawn."""
    tables = "scenes = 1\n[scene.airspace]\naltitude_m = [8, 30]\n[scene.receiver]\nnoise_w = 1.0\n"
    region = "x_m = [-1e7, 1e7]\ny_m = [-1e7, 1e7]\npower_w = 1.0\n"
    faults = _faults(tmp_path, f"{tables}reference_gain_db = 0.0\n[nodes]\n{nodes}\n{region}")
    assert words in faults["scene 0: nodes"]


def test_a_sweep_of_tables_in_tables(tmp_path: Path) -> None:
    """Tables nested deeper than any path are a fault, whatever their depth."""
    value = "{" + ".".join(["a"] * 60) + " = "
    faults = _faults(tmp_path, TOO_DEEP.format(value * 100 + "1" + "}" * 100))
    assert any("unknown key" in words for words in faults.values())


TOO_DEEP = """
scenes = 1
[scene.airspace]
altitude_m = [8, 30]
[scene.receiver]
noise_w = 1.0
reference_gain_db = 0.0
[nodes]
layout = "disc"
count = 1
centre_m = [0, 0]
radius_m = 1
power_w = 1.0
[sweep]
x = {}
"""


def test_a_file_in_motion_may_count_at_one_instant(tmp_path: Path) -> None:
    """At that which the spec states, and each scene says so; else it moves. Without a file it is refused."""
    shutil.copy(EXAMPLE.with_name("moving_jammer.toml"), tmp_path)
    spec = 'scenes = 1\n[scene]\nfile = "moving_jammer.toml"\n'
    scene = draw_scene(_load(tmp_path, spec), 0)
    assert (scene.jammers[0].position_m[0], scene.jammers[0].velocity_m_s[0]) == (-60.0, 4.0)
    scene = draw_scene(_load(tmp_path, f"{spec}at_s = 12.5\n"), 0)
    assert (scene.jammers[0].position_m[0], scene.at_s) == (-10.0, 12.5)
    drawn = '[nodes]\nlayout = "disc"\ncentre_m = [0, 0]\nradius_m = 5.0\ncount = 2\npower_w = 1.0\n'
    drawn += "height_m = 0.0\n"
    assert draw_scene(_load(tmp_path, f"{spec}at_s = 12.5\n{drawn}"), 0).at_s == 12.5
    assert list(_faults(tmp_path, f"{spec}at_s = 61\n")) == ["scene.at_s"]
    assert list(_faults(tmp_path, f'{spec}at_s = "noon"\n')) == ["scene.at_s"]
    tables = "airspace = {altitude_m = [8, 30]}\nreceiver = {noise_w = 1.0, reference_gain_db = 0.0}\n"
    alone = f"scenes = 1\n[scene]\nat_s = 1.0\n{tables}{drawn}"
    assert list(_faults(tmp_path, alone)) == ["scene.at_s"]
