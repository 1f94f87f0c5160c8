"""Undo and redo over immutable views."""

from __future__ import annotations

from dataclasses import dataclass, replace

from nullpose.studio.view import View

_MOST = 200


@dataclass(frozen=True, slots=True)
class History:
    """The view now, those before it and those undone.

    Args:
        present: the view now.
        past: earlier ones, the last being the latest; at most 200 are kept.
        future: undone ones, the last being the next to redo.
        gesture: what the present view is the state of, such as one drag; empty if it is complete.
    """

    present: View
    past: tuple[View, ...] = ()
    future: tuple[View, ...] = ()
    gesture: str = ""

    def changed(self, view: View, gesture: str = "") -> History:
        """Return the history with a new view; all views of one gesture are undone together.

        Args:
            view: the new one.
            gesture: a name that all steps of one gesture share; empty for a change of its own.
        """
        if view == self.present:
            return self
        if gesture and gesture == self.gesture:
            return replace(self, present=view, future=())
        return History(present=view, past=(*self.past, self.present)[-_MOST:], gesture=gesture)

    def undone(self) -> History:
        """Return the history one step back; itself if there is none."""
        if not self.past:
            return self
        return History(present=self.past[-1], past=self.past[:-1], future=(*self.future, self.present))

    def redone(self) -> History:
        """Return the history one step forward again; itself if there is none."""
        if not self.future:
            return self
        return History(present=self.future[-1], past=(*self.past, self.present), future=self.future[:-1])
