"""The values of one thing of the scene as fields of the panel: typed, and taken with Enter."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from nullpose.studio.drawing import put
from nullpose.studio.edits import Entry

if TYPE_CHECKING:
    from viser import GuiApi

OnTyped = Callable[[dict[str, str]], bool]


_Shape = tuple[tuple[str, tuple[str, ...]], ...]


class Inspector:
    """Fields in a folder of the panel.

    Args:
        gui: the page's interface.
        folder: where the fields go.
        on_typed: called with the texts of all fields, by path; returns whether they were taken.
    """

    def __init__(self, gui: GuiApi, folder: Any, on_typed: OnTyped) -> None:
        self._gui, self._folder, self._on_typed = gui, folder, on_typed
        self._entries: Sequence[Entry] = ()
        self._forms: dict[_Shape, tuple[Any, list[Any]]] = {}  # hidden and kept: to take one away costs more

    def show(self, entries: Sequence[Entry]) -> None:
        """Show values; what is being typed stays while they are as they were.

        Args:
            entries: the values now; none hide all fields.
        """
        if entries == self._entries:
            return
        self._entries, shape = entries, _shape(entries)
        if entries and shape not in self._forms:
            self._forms[shape] = self._built(entries)
        for own, (form, _) in self._forms.items():
            put(form, visible=own == shape)
        self._put_back()

    @property
    def _controls(self) -> list[Any]:
        return self._forms[_shape(self._entries)][1] if self._entries else []

    def _built(self, entries: Sequence[Entry]) -> tuple[Any, list[Any]]:
        """Return a form with its fields."""
        gui, controls = self._gui, []
        with self._folder:
            form = gui.add_form(None)
        with form:
            for entry in entries:
                hint = f"{entry.path.rpartition('.')[2]}; Enter takes it."
                more: dict[str, Any] = {"initial_value": entry.text, "hint": hint}
                if entry.options:
                    control: Any = gui.add_dropdown(entry.label, entry.options, **more)
                    control.on_update(self._chosen)
                else:
                    control = gui.add_text(entry.label, **more)
                controls.append(control)
        form.on_submit(lambda event: self._typed())
        return form, controls

    def _chosen(self, event: Any) -> None:
        if event.client is not None:  # a user did it, and not the program
            self._typed()

    def _typed(self) -> None:
        texts = {
            entry.path: control.value for entry, control in zip(self._entries, self._controls, strict=True)
        }
        if not self._on_typed(texts):
            self._put_back()

    def _put_back(self) -> None:
        for entry, control in zip(self._entries, self._controls, strict=True):
            put(control, value=entry.text)


def _shape(entries: Sequence[Entry]) -> _Shape:
    """Return what the fields for entries depend on."""
    return tuple((entry.label, entry.options) for entry in entries)
