"""nullpose finds the best pose for a drone's antenna under jamming.

The drone carries one short dipole, whose null it can turn towards a jammer. Given ground nodes, jammers and
an airspace, nullpose finds the position and the attitude that maximise the smallest SINR over the nodes.

The names below are the public interface. Each is imported at its first use, so the import of the package is
fast.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

from nullpose.version import __version__

if TYPE_CHECKING:
    from nullpose.errors import (
        Fault,
        NullposeError,
        OutputError,
        ScenarioError,
        SolveError,
        UsageError,
        WrongTypeError,
    )
    from nullpose.physics import (
        Link,
        Pose,
        Poses,
        evaluate,
        min_margin,
        min_secrecy_rate,
        min_sinr,
        pose_frames,
    )
    from nullpose.scenario import (
        Airframe,
        Airspace,
        Antenna,
        Array,
        Eavesdropper,
        Jammer,
        Node,
        NoFlyZone,
        Origin,
        Receiver,
        Scenario,
        Transmitter,
        apply_overrides,
        json_schema,
        load,
    )
    from nullpose.solve import (
        ArraySolution,
        ErrorSizes,
        ManySolutions,
        Scheme,
        Solution,
        Status,
        compare,
        sensitivity,
        solve,
        solve_array,
        solve_many,
    )
    from nullpose.solve.robust import RobustSolution, guarantee, solve_robust
    from nullpose.studio.show import show
    from nullpose.study import (
        AirframeComparison,
        SweepTable,
        compare_airframes,
        evaluate_against,
        poses_from_csv,
        sweep,
        value_map,
    )

__all__ = [
    "Airframe",
    "AirframeComparison",
    "Airspace",
    "Antenna",
    "Array",
    "ArraySolution",
    "Eavesdropper",
    "ErrorSizes",
    "Fault",
    "Jammer",
    "Link",
    "ManySolutions",
    "NoFlyZone",
    "Node",
    "NullposeError",
    "Origin",
    "OutputError",
    "Pose",
    "Poses",
    "Receiver",
    "RobustSolution",
    "Scenario",
    "ScenarioError",
    "Scheme",
    "Solution",
    "SolveError",
    "Status",
    "SweepTable",
    "Transmitter",
    "UsageError",
    "WrongTypeError",
    "__version__",
    "apply_overrides",
    "compare",
    "compare_airframes",
    "evaluate",
    "evaluate_against",
    "guarantee",
    "json_schema",
    "load",
    "min_margin",
    "min_secrecy_rate",
    "min_sinr",
    "pose_frames",
    "poses_from_csv",
    "sensitivity",
    "show",
    "solve",
    "solve_array",
    "solve_many",
    "solve_robust",
    "sweep",
    "value_map",
]

_ROOMS = {
    "nullpose.errors": (
        "Fault",
        "NullposeError",
        "OutputError",
        "ScenarioError",
        "SolveError",
        "UsageError",
        "WrongTypeError",
    ),
    "nullpose.physics": (
        "Link",
        "Pose",
        "Poses",
        "evaluate",
        "min_margin",
        "min_secrecy_rate",
        "min_sinr",
        "pose_frames",
    ),
    "nullpose.scenario": (
        "Airframe",
        "Airspace",
        "Antenna",
        "Array",
        "Eavesdropper",
        "Jammer",
        "NoFlyZone",
        "Node",
        "Origin",
        "Receiver",
        "Scenario",
        "Transmitter",
        "apply_overrides",
        "json_schema",
        "load",
    ),
    "nullpose.solve": (
        "ArraySolution",
        "ErrorSizes",
        "ManySolutions",
        "Scheme",
        "Solution",
        "Status",
        "compare",
        "sensitivity",
        "solve",
        "solve_array",
        "solve_many",
    ),
    "nullpose.solve.robust": ("RobustSolution", "guarantee", "solve_robust"),
    "nullpose.study": (
        "AirframeComparison",
        "SweepTable",
        "compare_airframes",
        "evaluate_against",
        "poses_from_csv",
        "sweep",
        "value_map",
    ),
    "nullpose.studio.show": ("show",),
}
_ROOM_OF = {name: room for room, names in _ROOMS.items() for name in names}


class _Face(ModuleType):
    """This package, on which a public name always wins over a room of the same name.

    Importing the room ``nullpose.solve`` would otherwise rebind ``nullpose.solve`` from the function to the
    room, so that what the name means would depend on what was imported before.
    """

    def __setattr__(self, name: str, value: object) -> None:
        if not (isinstance(value, ModuleType) and name in _ROOM_OF):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Face


def __getattr__(name: str) -> Any:
    """Return a public name, or the module ``plot``, importing it at the first use (PEP 562)."""
    if name == "plot":
        return import_module("nullpose.plot")
    if name not in _ROOM_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(_ROOM_OF[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the public names beside what the module holds already."""
    return sorted({*globals(), *__all__, "plot"})
