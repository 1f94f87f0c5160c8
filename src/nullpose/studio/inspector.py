"""The values of one thing of the scene as fields of the panel: typed or chosen, and taken one by one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from nullpose.studio.drawing import put
from nullpose.studio.edits import Entry
from nullpose.studio.panel import by_hand

if TYPE_CHECKING:
    from viser import GuiApi

_Shape = tuple[tuple[str, tuple[str, ...]], ...]


class Inspector:
    """Fields in a folder of the panel.

    Args:
        gui: the page's interface.
        folder: where the fields go.
        on_typed: called with the text of a field, by its path; it shows the values that hold then.
    """

    def __init__(self, gui: GuiApi, folder: Any, on_typed: Callable[[dict[str, str]], object]) -> None:
        self._gui, self._folder, self._on_typed = gui, folder, on_typed
        self._entries: Sequence[Entry] = ()
        self._groups: dict[_Shape, tuple[Any, list[Any]]] = {}  # hidden and kept: to remove one costs more

    def show(self, entries: Sequence[Entry]) -> None:
        """Show values; what is being typed stays while they are as they were.

        Args:
            entries: the values now; none hide all fields.
        """
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
        """Return a group with its fields."""
        gui, controls = self._gui, []
        with self._folder:
            group = gui.add_folder(None)
        with group:
            for index, entry in enumerate(entries):
                typed = partial(self._typed, _shape(entries), index)
                hint = f"{entry.path.rpartition('.')[2]}; Enter takes it, and so does leaving the field."
                more: dict[str, Any] = {"initial_value": entry.text, "hint": hint}
                if entry.options:
                    control: Any = gui.add_dropdown(entry.label, entry.options, **more)
                else:
                    control = gui.add_text(entry.label, **more)
                control.on_update(by_hand(typed))
                controls.append(control)
        return group, controls

    def _typed(self, shape: _Shape, index: int, text: str) -> None:
        if shape != _shape(self._entries):
            return  # something else is selected by now
        self._on_typed({self._entries[index].path: text})
        self._groups[shape][1][index].value = self._entries[index].text  # also if viser has it already


def _shape(entries: Sequence[Entry]) -> _Shape:
    """Return what the fields for entries depend on."""
    return tuple((entry.label, entry.options) for entry in entries)
