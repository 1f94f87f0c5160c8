"""The values of one thing of the scene as fields of the panel: typed, and taken with Enter."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from nullpose.studio.edits import Entry

if TYPE_CHECKING:
    from viser import GuiApi

OnTyped = Callable[[dict[str, str]], bool]


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
        self._controls: list[Any] = []
        self._form: Any = None

    def show(self, entries: Sequence[Entry]) -> None:
        """Show values; what is being typed stays while they are as they were.

        Args:
            entries: the values now; none take all fields away.
        """
        if entries == self._entries:
            return
        shape = [(entry.label, entry.options) for entry in entries]
        if shape != [(entry.label, entry.options) for entry in self._entries]:
            self._build(entries)
        self._entries = entries
        self._put_back()

    def _build(self, entries: Sequence[Entry]) -> None:
        if self._form is not None:
            self._form.remove()
            self._form = None
        self._controls = []
        if not entries:
            return
        with self._folder:
            self._form = self._gui.add_form(None)
        with self._form:
            for entry in entries:
                hint = f"{entry.path.rpartition('.')[2]}; Enter takes it."
                if entry.options:
                    control: Any = self._gui.add_dropdown(entry.label, entry.options, hint=hint)
                    control.on_update(self._chosen)
                else:
                    control = self._gui.add_text(entry.label, "", hint=hint)
                self._controls.append(control)
        self._form.on_submit(lambda event: self._typed())

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
            if control.value != entry.text:
                control.value = entry.text
