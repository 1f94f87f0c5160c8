"""From a file to the spec of a study, with every fault: of its parts, and between them on scenes drawn."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import partial
from pathlib import Path

from nullpose.errors import Fault, ScenarioError, UsageError, require_usage
from nullpose.files import PlainTable
from nullpose.objectives import USUAL
from nullpose.problem.schemes import Scheme
from nullpose.scenario import Scenario, load
from nullpose.scenario.faults import call_each, path_of, raise_all, refusal
from nullpose.scenario.motion import time_of
from nullpose.scenario.toml_file import FileKind, file_text, inside, tables_of
from nullpose.study.case import Case
from nullpose.study.monte_carlo.draw import Draws
from nullpose.study.monte_carlo.spec import StudySpec

# In place of a scenario file that is faulty.
_STAND_IN: PlainTable = {
    "airspace": {"altitude_m": [10.0, 20.0]},
    "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
    "nodes": [{"position_m": [0.0, 0.0, 0.0], "power_w": 1.0}],
}

_TRIED_SCENES = 5  # one that cannot be drawn may be bad luck, so many cannot
_TRIED_VALUES = 50  # of each swept path, both ends among them


def load_spec(path: str | os.PathLike[str], *, allow_outside: bool = False) -> StudySpec:
    """Return the spec that a TOML file states, with what the scenario files hold that it names.

    The first scene is drawn, and its swept values and cases are tried on it without solving anything.

    Args:
        path: the file, of 10 MB at most.
        allow_outside: whether files that are named may be outside the folder of the one that names them.

    Raises:
        ScenarioError: when the file, or one that it names, cannot be read or is faulty; with every fault.
    """
    source = os.fspath(path)
    faults: list[Fault] = []
    try:
        tables = tables_of(file_text(Path(source), FileKind("the spec of a study", "study.toml")))
        faults = _read_scenarios(tables, Path(source).parent, allow_outside)
        spec = StudySpec.from_dict(tables)
    except ScenarioError as error:
        raise ScenarioError([*faults, *error.faults], source) from None
    raise_all(faults, source)
    require_sound(spec, source)
    return spec


def _read_scenarios(tables: PlainTable, folder: Path, allow_outside: bool) -> list[Fault]:
    """Put what the named scenario files hold into the raw spec; return their faults."""
    if not isinstance(scene := tables.get("scene"), Mapping):
        return []
    if "scenarios" in scene:
        return [Fault("scene.scenarios", "cannot be stated in a file; name scenario files by file or files")]
    file, files = scene.get("file"), scene.get("files")
    listed = [file] if files is None else files if isinstance(files, list) else []
    names = [name for name in listed if isinstance(name, str)]  # the spec refuses what is no name
    at_s = scene.get("at_s")

    def read(name: str) -> PlainTable:
        try:
            whole = load(inside(folder, name, allow_outside), allow_outside=allow_outside)
            return (whole.still(at_s) if isinstance(at_s, int | float) else whole).to_dict()
        except UsageError as error:
            raise refusal("scene.at_s", f"{name}: {error}") from None
        except ScenarioError as error:
            paths = [f"{name}: {fault.path}" if fault.path else name for fault in error.faults]
            raise ScenarioError([*map(Fault, paths, [each.message for each in error.faults])]) from None

    held, faults = call_each(read, names)
    if names:  # other faults are reported too; stand-ins keep that free of what only follows
        tables["scene"] = {**scene, "scenarios": held + [_STAND_IN] * (len(names) - len(held))}
    return faults


def require_sound(spec: StudySpec, source: str = "study") -> None:
    """Raise a ScenarioError with what is wrong between the parts of a spec, each of which is sound by itself.

    Args:
        spec: the study.
        source: what to call it in messages.

    Raises:
        ScenarioError: with every fault.
    """
    draws = Draws(spec)
    unsound = {index: _faults_at(draws, index, {}) for index in range(min(_TRIED_SCENES, spec.n_scenes))}
    if sound := [index for index, found in unsound.items() if not found]:
        faults = _sweep_faults(draws, spec, sound[0])
        faults = faults or _cases_faults(spec, [draws.at(sound[0], 0), draws.at(sound[0], -1)])
    else:
        faults = [Fault(f"scene 0: {each.path}", each.message) for each in unsound[0]]
    raise_all(faults, source)


def _faults_at(draws: Draws, index: int, values: Mapping[str, float]) -> list[Fault]:
    return call_each(partial(draws.base, index), [values])[1]


def _sweep_faults(draws: Draws, spec: StudySpec, index: int) -> list[Fault]:
    """Return the faults that the values of each path lead to, each once."""
    faults_by_path: dict[tuple[str, str], Fault] = {}
    for path, values in spec.sweep:
        step = max(1, len(values) // _TRIED_VALUES)
        for value in dict.fromkeys((*values[::step], values[-1])):
            for fault in _faults_at(draws, index, {path: value}):
                faults_by_path.setdefault(
                    (path, fault.path), Fault(path_of(("sweep", path)), f"{fault.message} (at {value:g})")
                )
    return list(faults_by_path.values())


def _cases_faults(spec: StudySpec, scenes: list[Scenario]) -> list[Fault]:
    """List the reasons for which cases have no meaning in scenes."""
    found = {
        place: list(filter(None, (_meaningless(case, scene) for scene in scenes)))
        for place, case in enumerate(spec.cases)
    }
    return [Fault(path_of(("cases", place)), reasons[0]) for place, reasons in found.items() if reasons]


def _meaningless(case: Case, scene: Scenario) -> str:
    """Give the reason for which a case has no meaning in a scene; empty if it has."""
    try:
        vehicle = case.drawn(scene)
        require_usage(
            vehicle.is_uncertain or not case.robust,
            "robust, but the scenes state no errors; add uncertainty_m to jammers or eavesdroppers, or "
            "receiver.attitude_error_deg or receiver.position_error_m to the scene",
        )
        require_usage(
            case.array is None or vehicle.objective == USUAL,
            "an array is for a drone that receives, not for this objective",
        )
        if case.flight is not None:
            time_of(vehicle, f"flight = {case.flight}: asked for")
            require_usage(
                case.flight == "hover" or (vehicle.airframe and vehicle.airframe.speed_max_m_s),
                "airframe.speed_max_m_s: missing; a trajectory needs the largest speed, in m/s",
            )
        elif not (case.robust or case.array or case.pose):
            (case.scheme or Scheme.OPTIMUM).require_applicable(vehicle)
    except (ScenarioError, UsageError) as error:
        return str(error)
    return ""
