"""The controls of the panel's tabs, as data."""

from __future__ import annotations

from nullpose.studio.edits import ADDED
from nullpose.studio.field_map import MAPS
from nullpose.studio.picking import FENCE
from nullpose.studio.state import POWER_DB

NO_CASE = "nothing"
"""In the choice of a second case: there is none."""

TABS: dict[str, dict[str, tuple[str, str, str, dict[str, object]]]] = {
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
        "undo": ("button", "Undo", "Take back the last change.", {"disabled": True}),
        "redo": ("button", "Redo", "Make the change again that was taken back.", {"disabled": True}),
    },
    "Edit": {
        "add": (
            "button_group",
            "Add",
            "Then click on the ground. A point is selected with a click, and then dragged by its arrows.",
            {"options": (*ADDED, FENCE)},
        ),
        "tool": ("html", "", "", {}),
        "vehicle_values": ("folder", "Vehicle and airspace", "", {}),
        "new": (
            "button",
            "New scene",
            "Begin with one node on an empty ground; Undo brings the last one back.",
            {},
        ),
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
        "lifts_points": (
            "checkbox",
            "Points leave the ground",
            "Let points be dragged up and down too.",
            {"initial_value": False},
        ),
        "aim": ("button", "Reset the camera", "Look at the whole scene again.", {}),
        "present": (
            "button",
            "Present",
            "Fold the panel (key: P); again, or Escape: unfold it.",
            {},
        ),
    },
    "Files": {
        "upload": (
            "upload_button",
            "Load scenario",
            "Open a scenario file (TOML); faults are listed above.",
            {"mime_type": ".toml"},
        ),
        "save": ("button", "Save scenario", "Download the scene as a scenario file (TOML).", {}),
        "pose": ("button", "Export pose", "Download the pose and its values (JSON).", {}),
        "figure": ("button", "Export figure", "Download the power plot (PNG).", {}),
        "picture": (
            "button",
            "Export picture",
            "Download what is seen of the scene as a picture (PNG), with value, bound and colours.",
            {},
        ),
        "html": (
            "button",
            "Export scene",
            "Download the 3-D scene as one HTML file that needs no server.",
            {},
        ),
    },
}
"""The controls of each tab, by name: kind, label, help, and more of viser's arguments."""
