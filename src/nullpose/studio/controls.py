"""The controls of the panel's tabs, as data."""

from __future__ import annotations

from nullpose.studio.edits import ADDED
from nullpose.studio.field_map import MAPS
from nullpose.studio.picking import FENCE, RULER
from nullpose.studio.state import POWER_DB

NO_CASE = "nothing"
"""In the choice of a second case: there is none."""

_GREY: dict[str, object] = {"color": "gray"}
Control = tuple[str, str, str, dict[str, object]]
"""Kind, label, help, and more of viser's arguments."""

TABS: dict[str, dict[str, Control | dict[str, Control]]] = {
    "Scene": {
        "power": (
            "multi_slider",  # of one handle: viser's other one has a field that takes every keystroke
            "Jamming (dB)",
            "Power of the strongest jammer over the strongest node's (P_M/P); all jammers change alike.",
            {"min": POWER_DB[0], "max": POWER_DB[1], "step": 0.5, "initial_value": (0.0,)},
        ),
        "power_text": (
            "text",
            "typed (dB)",
            "The jamming power in dB; Enter takes it, and so does leaving the field.",
            {"initial_value": ""},
        ),
        "case": (
            "dropdown",
            "Case",
            "How the pose is chosen: the paper's four cases, a vehicle, or robust.",
            {"options": ("-",)},
        ),
        "compared": (
            "dropdown",
            "Compare with",
            "A second case, whose drone (B) is drawn beside the first (A).",
            {"options": (NO_CASE,)},
        ),
        "plot": ("html", "", "", {}),
        # pressed by the icons in the panel's head, which the frame's script draws
        "undo": ("button", "Undo", "", {"disabled": True, "visible": False}),
        "redo": ("button", "Redo", "", {"disabled": True, "visible": False}),
    },
    "Edit": {
        "add": (
            "button_group",
            "Add",
            "Then click on the ground. The ruler measures from one click to the next.",
            {"options": (*ADDED, FENCE, RULER)},
        ),
        "tool": ("html", "", "", {}),
        "vehicle_values": ("folder", "Vehicle and airspace", "", {}),
    },
    "Map and view": {
        "map_name": (
            "dropdown",
            "Map",
            "Colour a plane: the best possible at each place, or where the pattern falls on the ground.",
            {"options": ("no map", *MAPS), "initial_value": MAPS[1]},
        ),
        "has_pattern": (
            "checkbox",
            "Radiation pattern",
            "Show the antenna's radiation pattern.",
            {"initial_value": True},
        ),
        "has_shadows": (
            "checkbox",
            "Shadows of buildings",
            "At the drone's altitude: where buildings hide nodes (filled) and jammers (hatched).",
            {"initial_value": True},
        ),
        "aim": ("button", "Reset the camera", "Look at the whole scene again.", _GREY),
        "present": (
            "button",
            "Present",
            "Fold the panel and turn the scene (key: P); Escape ends it.",
            _GREY,
        ),
    },
    "Files": {
        "Open and save": {
            "save": ("button", "Save scenario", "Download the scene as a scenario file (TOML).", {}),
            "upload": (
                "upload_button",
                "Load scenario",
                "Open a scenario file (TOML); faults are listed above.",
                {"mime_type": ".toml"} | _GREY,
            ),
            "new": (
                "button",
                "New scene",
                "Begin with one node on an empty ground; Undo brings the last one back.",
                _GREY,
            ),
        },
        "Export": {
            "pose": ("button", "Export pose", "Download the pose and its values (JSON).", _GREY),
            "figure": (
                "button",
                "Export figure",
                "Download the scene and its pose as solve --figure draws them (PNG).",
                _GREY,
            ),
            "html": (
                "button",
                "Export scene",
                "Download the 3-D scene as one HTML file that needs no server.",
                _GREY,
            ),
        },
    },
}
"""The controls of each tab by name, some of them in groups."""
