"""The panel: its controls, each with one line of help, and the fields of what is selected."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable, Mapping
from functools import partial
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from nullpose.objectives import Quantity
from nullpose.studio.answer import PowerCurve
from nullpose.studio.case import cases_of
from nullpose.studio.edits import ADDED, Entry, entries_of
from nullpose.studio.field_map import MAPS
from nullpose.studio.picking import FENCE, RULER
from nullpose.studio.plot import power_plot_svg
from nullpose.studio.readout import card_html, macros, readout_html
from nullpose.studio.session import History
from nullpose.studio.state import POWER_DB, State

if TYPE_CHECKING:
    from viser import GuiApi, GuiDropdownHandle, GuiEvent, GuiFolderHandle, GuiTextHandle

NO_CASE = "nothing"
"""In the choice of a second case: there is none."""

_GREY: dict[str, object] = {"color": "gray"}
Control = tuple[str, str, str, dict[str, object]]
"""Kind, label, help, and more of viser's arguments."""

_ABOVE: dict[str, Control] = {
    # these three are not in the panel: the frame's script shows two, and tells where the pointer is
    "overlay": ("html", "", "", {"visible": False}),
    "tip": ("html", "", "", {"visible": False}),
    "pointer": ("text", "Pointer", "", {"initial_value": "", "visible": False}),
    "readout": ("html", "", "", {}),
    "faults": ("html", "", "", {}),
    "selected_values": ("folder", "Selected", "", {"visible": False}),
}
TABS: dict[str, dict[str, Control | dict[str, Control]]] = {
    "Scene": {
        "time": (
            "multi_slider",
            "Time (s)",
            "The instant of the scene in motion that is shown and solved.",
            {"min": 0.0, "max": 1.0, "step": 1.0, "initial_value": (0.0,), "visible": False},
        ),
        "play": (
            "button",
            "Play or stop",
            "Go through the instants to the last, each when its pose is found, at most five a second.",
            {"visible": False} | _GREY,
        ),
        "plan": (
            "button",
            "Plan flight",
            "Find a flight through all instants within the vehicle's speed, and a bound that none exceeds.",
            {"visible": False} | _GREY,
        ),
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

_Look = tuple[str, tuple[str, ...]]  # of a field: its label and its options


class Panel(SimpleNamespace):
    """The controls of one page, by name: those of the tabs, and above them ``readout`` and ``faults``.

    A text arrives whole, with Enter or when its field is left.

    Args:
        gui: the page's interface.
        on_typed: called with a typed value and its text.
        dark: whether it is dark.
    """

    def __init__(self, gui: GuiApi, on_typed: Callable[[Entry, str], object], *, dark: bool = False) -> None:
        super().__init__()
        gui.configure_theme(control_width="large", dark_mode=dark, show_logo=False, show_share_button=False)
        gui.main_panel.dock_right()
        gui.set_panel_label("nullpose studio")
        self._add(gui, _ABOVE)
        with self.selected_values:
            self.delete = gui.add_button(
                "Delete", order=1e6, hint="Take it out of the scene (key: Delete).", color="gray"
            )
        tabs = gui.add_tab_group()
        for tab, controls in TABS.items():
            with tabs.add_tab(tab):
                self._add(gui, controls)
        self._selected = _Fields(gui, self.selected_values, on_typed)
        self._vehicle = _Fields(gui, self.vehicle_values, on_typed)

    def _add(self, gui: GuiApi, controls: Mapping[str, Control | dict[str, Control]]) -> None:
        for name, control in controls.items():
            if isinstance(control, dict):
                with gui.add_folder(name):
                    self._add(gui, control)
            else:
                kind, label, hint, more = control
                setattr(
                    self, name, getattr(gui, f"add_{kind}")(label, **more | ({"hint": hint} if hint else {}))
                )

    def render(self, history: History) -> None:
        """Show the present state, and whether there is a step to undo or to redo.

        Args:
            history: of the page.
        """
        state, answer = history.present, history.present.current(history.present.case)
        labels, power_db = tuple(case.label for case in cases_of(state.scenario)), state.power_db
        others = (NO_CASE, *(label for label in labels if label != state.case.label))
        entries = () if state.selected is None else entries_of(state, state.selected)
        svg = power_plot_svg(
            state.latest(PowerCurve),
            version=state.version,
            power_db=power_db,
            # while a hand moves the plot is grey and stays as it is
            value=answer.shown_value if answer and state.dragged is None else None,
            unit=Quantity.of(state.scenario).unit,
        )
        shown: dict[str, dict[str, object]] = {
            "time": _time_values(state),
            "play": {"visible": state.motion is not None},
            "plan": {
                "visible": bool(
                    state.motion and state.motion.airframe and state.motion.airframe.speed_max_m_s
                )
            },
            "case": {"options": labels, "value": state.case.label},
            "compared": {"options": others, "value": state.compared.label if state.compared else NO_CASE},
            "power": {"disabled": power_db is None},
            "power_text": {"disabled": power_db is None, "value": state.power_text},
            "map_name": {"value": state.map_name},
            "has_pattern": {"value": state.has_pattern},
            "has_shadows": {"value": state.has_shadows, "visible": state.scenario.prisms is not None},
            "undo": {"disabled": not history.past},
            "redo": {"disabled": not history.future},
            "selected_values": {"visible": bool(entries)},
            "tool": {"content": str(macros().tool(state))},
            "faults": {"content": state.faults or str(macros().faults(None))},
            "readout": {"content": readout_html(state)},
            "overlay": {"content": card_html(state)},
            "plot": {"content": svg},
        }
        if power_db is not None:
            shown["power"]["value"] = (round(min(max(power_db, POWER_DB[0]), POWER_DB[1]), 6),)
        if entries:
            shown["selected_values"]["label"] = f"Selected: {entries[0].text}"
        for name, values in shown.items():
            put(getattr(self, name), **values)
        self._selected.render(entries)
        self._vehicle.render(entries_of(state, None))


def _time_values(state: State) -> dict[str, object]:
    if state.motion is None or state.motion.time is None:
        return {"visible": False}
    step_s, last_s = state.motion.time.step_s, state.motion.time.duration_s
    digits = max(len(f"{t_s:.4g}".partition(".")[2]) for t_s in (step_s, last_s))
    return {
        "visible": True,
        "max": last_s,
        "step": step_s,
        "precision": digits,
        "value": (state.scenario.at_s,),
    }


class _Fields:
    """Values as fields in a folder of the panel: typed or chosen, and taken one by one."""

    def __init__(
        self, gui: GuiApi, folder: GuiFolderHandle, on_typed: Callable[[Entry, str], object]
    ) -> None:
        self._gui, self._folder, self._on_typed = gui, folder, on_typed
        self._entries: dict[_Look, Entry] = {}
        self._fields: dict[
            _Look, GuiDropdownHandle | GuiTextHandle
        ] = {}  # hidden and kept: to remove one costs more

    def render(self, entries: Iterable[Entry]) -> None:
        """Show values; what is being typed stays while they are as they were."""
        self._entries = {(entry.label, entry.options): entry for entry in entries}
        for look, field in self._fields.items():
            put(field, visible=look in self._entries)
        for place, (look, entry) in enumerate(self._entries.items()):
            if look not in self._fields:
                self._fields[look] = self._added(entry)
            put(self._fields[look], value=entry.text, order=float(place))

    def _added(self, entry: Entry) -> GuiDropdownHandle | GuiTextHandle:
        gui, look = self._gui, (entry.label, entry.options)
        hint = f"{entry.path.rpartition('.')[2]}; Enter takes it, and so does leaving the field."
        add = partial(gui.add_dropdown, options=entry.options) if entry.options else gui.add_text
        with self._folder:
            field = add(entry.label, initial_value=entry.text, hint=hint)
        field.on_update(by_hand(partial(self._typed, look)))
        return field

    def _typed(self, look: _Look, text: str) -> None:
        if look in self._entries:  # unless something else is selected by now
            self._on_typed(self._entries[look], text)
            self._fields[look].value = self._entries[look].text  # also if viser has it already


def put(handle: object, **values: object) -> None:
    """Set what differs of a control: what is set as it was would be sent all the same.

    Args:
        handle: of viser's.
        values: by their names.
    """
    for name, value in values.items():
        if getattr(handle, name) != value:
            setattr(handle, name, value)


def by_hand(action: Callable[[Any], object]) -> Callable[[GuiEvent], Awaitable[None]]:
    """Return a callback of a control for what a user does, and not the program; called in order, in the loop.

    Args:
        action: called with the control's new value.
    """

    async def callback(event: GuiEvent) -> None:
        if event.client is not None:
            action(event.target.value)

    return callback
