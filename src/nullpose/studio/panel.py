"""The panel's controls, each with one line of help that shows when it is pointed at."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from nullpose.studio.case import cases_of
from nullpose.studio.drawing import put
from nullpose.studio.edits import ADDED
from nullpose.studio.field_map import MAPS
from nullpose.studio.readout import about_html, failure_html
from nullpose.studio.view import POWER_DB, View

if TYPE_CHECKING:
    from viser import GuiApi

NO_CASE = "nothing"
"""In the choice of a second case: there is none."""

FENCE = "fence"
"""In the choice of what to add: the fence, whose corners are clicked one after the other."""

_TABS: dict[str, dict[str, tuple[str, str, str, dict[str, Any]]]] = {
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
        "map": (
            "dropdown",
            "Map",
            "Colour a plane: the best possible at each place, or where the pattern falls on the ground.",
            {"options": ("no map", *MAPS), "initial_value": MAPS[1]},
        ),
        "pattern": (
            "checkbox",
            "Radiation pattern",
            "Show the antenna's radiation pattern.",
            {"initial_value": True},
        ),
        "freed": (
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
"""What each tab holds, by name: the kind of control, its label, its help, and more of what viser takes."""


class Panel(SimpleNamespace):
    """The controls of one page, by name: those of the tabs, and above them ``readout`` and ``faults``.

    A text arrives whole, with Enter or when its field is left. ``overlay`` is not in the panel.

    Args:
        gui: the page's interface.
        dark: whether it is dark.
    """

    def __init__(self, gui: GuiApi, *, dark: bool = False) -> None:
        super().__init__()
        self._shown: View | None = None
        shown = {"show_logo": False, "show_share_button": False}
        gui.configure_theme(control_width="large", dark_mode=dark, **shown)
        gui.main_panel.dock_right()
        gui.set_panel_label("nullpose studio")
        folder = gui.add_folder("What am I looking at?")
        with folder:
            gui.add_html(about_html())
            close = gui.add_button("Got it", hint="Close this explanation.")
        close.on_click(lambda event: folder.remove())
        self.overlay = gui.add_html("", visible=False)  # shown by the frame's script
        self.readout = gui.add_html("")
        self.faults = gui.add_html(failure_html(None))
        self.own_values = gui.add_folder("Selected", visible=False)
        with self.own_values:
            self.delete = gui.add_button("Delete", order=1e6, hint="Take it out of the scene (key: Delete).")
        tabs = gui.add_tab_group()
        for tab, controls in _TABS.items():
            with tabs.add_tab(tab):
                for name, (kind, label, hint, more) in controls.items():
                    given = more | ({"hint": hint} if hint else {})
                    setattr(self, name, getattr(gui, f"add_{kind}")(label, **given))

    def show(self, view: View) -> None:
        """Offer the cases that have a meaning for a view, and show those chosen, and the jamming power.

        Args:
            view: the view now.
        """
        labels = tuple(case.label for case in cases_of(view.scenario))
        others = (NO_CASE, *(label for label in labels if label != view.case.label))
        put(self.case, options=labels, value=view.case.label)
        put(self.compared, options=others, value=NO_CASE if view.compared is None else view.compared.label)
        if view is not self._shown:  # what is being typed stays while the answers to a view come in
            self.show_power(view)
        self._shown = view

    def show_power(self, view: View) -> None:
        """Show the jamming power that holds, in place of one that was typed and not taken.

        Args:
            view: the view now.
        """
        put(self.power, disabled=view.power_db is None)
        put(self.power_text, disabled=view.power_db is None, value=view.power_text)
        if view.power_db is not None:
            put(self.power, value=(round(min(max(view.power_db, POWER_DB[0]), POWER_DB[1]), 6),))


def by_hand(action: Callable[[Any], object]) -> Any:
    """Return a callback of a control for what a user does, and not the program; called in order, in the loop.

    Args:
        action: called with the control's new value.
    """

    async def callback(event: Any) -> None:
        if event.client is not None:
            action(event.target.value)

    return callback
