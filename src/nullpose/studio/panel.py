"""The panel: its controls, each with one line of help, and the fields of what is selected."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from nullpose.objectives import Quantity
from nullpose.studio.card import card_html
from nullpose.studio.case import cases_of
from nullpose.studio.controls import NO_CASE, TABS
from nullpose.studio.drawing import put
from nullpose.studio.edits import Entry, entries_of
from nullpose.studio.picking import FENCE
from nullpose.studio.plot import power_plot_svg
from nullpose.studio.readout import about_html, failure_html, readout_html, tool_html
from nullpose.studio.session import History
from nullpose.studio.state import POWER_DB

if TYPE_CHECKING:
    from viser import GuiApi

_HOW = "Click on the ground to place the {}. Escape ends it."
_FENCE_HOW = (
    "Click the corners of the fence on the ground; click the first one again to close it ({} so far)."
)
_Shape = tuple[tuple[str, tuple[str, ...]], ...]


class Panel(SimpleNamespace):
    """The controls of one page, by name: those of the tabs, and above them ``readout`` and ``faults``.

    A text arrives whole, with Enter or when its field is left. ``overlay`` is not in the panel.

    Args:
        gui: the page's interface.
        on_typed: called with the path of a typed value and its text.
        dark: whether it is dark.
    """

    def __init__(self, gui: GuiApi, on_typed: Callable[[str, str], object], *, dark: bool = False) -> None:
        super().__init__()
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
        self.selected_values = gui.add_folder("Selected", visible=False)
        with self.selected_values:
            self.delete = gui.add_button("Delete", order=1e6, hint="Take it out of the scene (key: Delete).")
        tabs = gui.add_tab_group()
        for tab, controls in TABS.items():
            with tabs.add_tab(tab):
                for name, (kind, label, hint, more) in controls.items():
                    options = more | ({"hint": hint} if hint else {})
                    setattr(self, name, getattr(gui, f"add_{kind}")(label, **options))
        self._selected = _Fields(gui, self.selected_values, on_typed)
        self._vehicle = _Fields(gui, self.vehicle_values, on_typed)

    def render(self, history: History) -> None:
        """Show the present state, and whether there is a step to undo or to redo.

        Args:
            history: of the page.
        """
        state = history.present
        labels = tuple(case.label for case in cases_of(state.scenario))
        others = (NO_CASE, *(label for label in labels if label != state.case.label))
        put(self.case, options=labels, value=state.case.label)
        put(self.compared, options=others, value=NO_CASE if state.compared is None else state.compared.label)
        power_db = state.power_db
        put(self.power, disabled=power_db is None)
        put(self.power_text, disabled=power_db is None, value=state.power_text)
        if power_db is not None:
            put(self.power, value=(round(min(max(power_db, POWER_DB[0]), POWER_DB[1]), 6),))
        for name in ("map_name", "has_pattern", "lifts_points"):
            put(getattr(self, name), value=getattr(state, name))
        put(self.undo, disabled=not history.past)
        put(self.redo, disabled=not history.future)
        entries: tuple[Entry, ...] = () if state.selected is None else entries_of(state, state.selected)
        put(self.selected_values, visible=bool(entries))
        if entries:
            put(self.selected_values, label=f"Selected: {entries[0].text}")
        self._selected.render(entries)
        self._vehicle.render(entries_of(state, None))
        how = _FENCE_HOW.format(len(state.corners_m)) if state.tool == FENCE else _HOW.format(state.tool)
        put(self.tool, content=tool_html(how if state.tool else ""))
        put(self.faults, content=state.faults or failure_html(None))
        put(self.readout, content=readout_html(state))
        put(self.overlay, content=card_html(state))
        answer = state.current(state.case)
        svg = power_plot_svg(
            state.curve,
            version=state.version,
            power_db=power_db,
            # while a hand moves the plot is grey and stays as it is
            value=answer.shown_value if answer and state.dragged is None else None,
            unit=Quantity.of(state.scenario).unit,
        )
        put(self.plot, content=svg)


class _Fields:
    """Values as fields in a folder of the panel: typed or chosen, and taken one by one."""

    def __init__(self, gui: GuiApi, folder: Any, on_typed: Callable[[str, str], object]) -> None:
        self._gui, self._folder, self._on_typed = gui, folder, on_typed
        self._entries: Sequence[Entry] = ()
        self._groups: dict[_Shape, tuple[Any, list[Any]]] = {}  # hidden and kept: to remove one costs more

    def render(self, entries: Sequence[Entry]) -> None:
        """Show values; what is being typed stays while they are as they were."""
        if entries == self._entries:
            return
        self._entries, shape = entries, _shape(entries)
        if entries and shape not in self._groups:
            self._groups[shape] = self._built(entries)
        for other, (group, _) in self._groups.items():
            put(group, visible=other == shape)
        for entry, control in zip(entries, self._controls, strict=True):
            put(control, value=entry.text)

    @property
    def _controls(self) -> list[Any]:
        return self._groups[_shape(self._entries)][1] if self._entries else []

    def _built(self, entries: Sequence[Entry]) -> tuple[Any, list[Any]]:
        """Make a group with its fields."""
        gui, controls = self._gui, []
        with self._folder:
            group = gui.add_folder(None)
        with group:
            for index, entry in enumerate(entries):
                hint = f"{entry.path.rpartition('.')[2]}; Enter takes it, and so does leaving the field."
                more: dict[str, Any] = {"initial_value": entry.text, "hint": hint}
                if entry.options:
                    control: Any = gui.add_dropdown(entry.label, entry.options, **more)
                else:
                    control = gui.add_text(entry.label, **more)
                control.on_update(by_hand(partial(self._typed, _shape(entries), index)))
                controls.append(control)
        return group, controls

    def _typed(self, shape: _Shape, index: int, text: str) -> None:
        if shape != _shape(self._entries):
            return  # something else is selected by now
        self._on_typed(self._entries[index].path, text)
        self._groups[shape][1][index].value = self._entries[index].text  # also if viser has it already


def _shape(entries: Sequence[Entry]) -> _Shape:
    """Return the traits of entries on which their fields depend."""
    return tuple((entry.label, entry.options) for entry in entries)


def by_hand(action: Callable[[Any], object]) -> Any:
    """Return a callback of a control for what a user does, and not the program; called in order, in the loop.

    Args:
        action: called with the control's new value.
    """

    async def callback(event: Any) -> None:
        if event.client is not None:
            action(event.target.value)

    return callback
