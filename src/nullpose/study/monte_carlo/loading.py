"""From a file to the spec of a study, with every fault that it has."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from nullpose.errors import Fault, ScenarioError
from nullpose.scenario import load
from nullpose.scenario.loading import inside
from nullpose.scenario.toml_file import FileKind, file_text, tables_of
from nullpose.study.monte_carlo.checking import require_sound
from nullpose.study.monte_carlo.spec import StudySpec

__all__ = ["load_spec"]

_SPEC_FILE = FileKind("the spec of a study", "study.toml")


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
        tables = tables_of(file_text(Path(source), _SPEC_FILE))
        faults = _read_scenarios(tables, Path(source).parent, allow_outside)
        spec = StudySpec.from_dict(tables)
    except ScenarioError as error:
        raise ScenarioError([*faults, *error.faults], source) from None
    if faults:
        raise ScenarioError(faults, source)
    require_sound(spec, source)
    return spec


def _read_scenarios(tables: dict[str, Any], folder: Path, allow_outside: bool) -> list[Fault]:
    """Put what the named scenario files hold into the raw spec; return their faults."""
    scene = tables.get("scene")
    if not isinstance(scene, Mapping):
        return []
    if "scenarios" in scene:
        return [Fault("scene.scenarios", "cannot be stated in a file; name scenario files by file or files")]
    file, files = scene.get("file"), scene.get("files")
    names = [file] if files is None else files if isinstance(files, list) else []
    faults: list[Fault] = []
    held: list[dict[str, Any]] = []
    for name in names:
        if not isinstance(name, str):  # the spec says what is wrong with it
            continue
        try:
            held.append(load(inside(folder, name, allow_outside), allow_outside=allow_outside).to_dict())
        except ScenarioError as error:
            # Whatever else is faulty is told too; a stand-in keeps that free of what only follows.
            held.append(_STAND_IN)
            paths = [f"{name}: {fault.path}" if fault.path else name for fault in error.faults]
            faults += map(Fault, paths, [fault.message for fault in error.faults])
    if held:
        tables["scene"] = {**scene, "scenarios": held}
    return faults


_STAND_IN: dict[str, Any] = {
    "airspace": {"altitude_m": [10.0, 20.0]},
    "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
    "nodes": [{"position_m": [0.0, 0.0, 0.0], "power_w": 1.0}],
}
