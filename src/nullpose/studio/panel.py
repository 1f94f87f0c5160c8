"""The panel's controls, each with one line of help that shows when it is pointed at."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from nullpose.studio.case import cases_of
from nullpose.studio.readout import about_html, failure_html
from nullpose.studio.view import POWER_DB, View

if TYPE_CHECKING:
    from viser import GuiApi

__all__ = ["BEST_MAP", "FOOTPRINT", "NO_CASE", "NO_MAP", "Panel"]

NO_CASE = "nothing"
"""In the choice of a second case: there is none."""

NO_MAP, BEST_MAP, FOOTPRINT = "no map", "best value at each place", "pattern's footprint"


class Panel:
    """The controls of one page, by name.

    Args:
        gui: the page's interface.
    """

    def __init__(self, gui: GuiApi) -> None:
        self._gui = gui
        gui.configure_theme(control_width="large", show_logo=False, show_share_button=False)
        gui.main_panel.dock_right()
        gui.set_panel_label("nullpose studio")
        self._add_about()
        self.readout: Any = gui.add_html("")
        self.faults: Any = gui.add_html(failure_html(None))
        tabs = gui.add_tab_group()
        with tabs.add_tab("Scene"):
            self._add_scene_controls()
        with tabs.add_tab("Map and view"):
            self._add_view_controls()
        with tabs.add_tab("Files"):
            self._add_file_controls()

    def _add_about(self) -> None:
        folder = self._gui.add_folder("What am I looking at?")
        with folder:
            self._gui.add_html(about_html())
            close = self._gui.add_button("Got it", hint="Close this explanation.")
        close.on_click(lambda event: folder.remove())

    def _add_scene_controls(self) -> None:
        gui = self._gui
        self.power: Any = gui.add_slider(
            "Jamming (dB)",
            min=POWER_DB[0],
            max=POWER_DB[1],
            step=0.5,
            initial_value=0.0,
            hint="Power of the strongest jammer over the nodes' (P_M/P); all jammers change alike.",
        )
        self.case: Any = gui.add_dropdown(
            "Case", ("-",), hint="How the pose is chosen: the paper's four cases, a vehicle, or robust."
        )
        self.compared: Any = gui.add_dropdown(
            "Compare with", (NO_CASE,), hint="A second case, whose drone (B) is drawn beside the first (A)."
        )
        self.plot: Any = gui.add_html("")
        self.undo: Any = gui.add_button("Undo", disabled=True, hint="Take back the last change.")
        self.redo: Any = gui.add_button(
            "Redo", disabled=True, hint="Make the change again that was taken back."
        )

    def _add_view_controls(self) -> None:
        gui = self._gui
        self.map: Any = gui.add_dropdown(
            "Map",
            (NO_MAP, BEST_MAP, FOOTPRINT),
            initial_value=BEST_MAP,
            hint="Colour a plane: the best possible at each place, or where the pattern falls on the ground.",
        )
        self.scale: Any = gui.add_html("")
        self.pattern: Any = gui.add_checkbox(
            "Radiation pattern", True, hint="Show what the antenna hears, as a doughnut about it."
        )
        self.freed: Any = gui.add_checkbox(
            "Points leave the ground", False, hint="Let points be dragged up and down too."
        )
        self.aim: Any = gui.add_button("Reset the camera", hint="Look at the whole scene again.")

    def _add_file_controls(self) -> None:
        gui = self._gui
        self.upload: Any = gui.add_upload_button(
            "Load scenario", mime_type=".toml", hint="Open a scenario file (TOML); faults are listed above."
        )
        self.save: Any = gui.add_button("Save scenario", hint="Download the scene as a scenario file (TOML).")
        self.pose: Any = gui.add_button("Export pose", hint="Download the pose and its values (JSON).")
        self.figure: Any = gui.add_button("Export figure", hint="Download the power plot (PNG).")
        self.html: Any = gui.add_button(
            "Export scene", hint="Download the 3-D scene as one HTML file that needs no server."
        )

    def show_cases(self, view: View) -> None:
        """Offer the cases that have a meaning for a view, and show those chosen.

        Args:
            view: the view now.
        """
        labels = tuple(case.label for case in cases_of(view.scenario))
        _show_choice(self.case, labels, view.case.label)
        others = (NO_CASE, *(label for label in labels if label != view.case.label))
        _show_choice(self.compared, others, NO_CASE if view.compared is None else view.compared.label)

    def show_power(self, power_db: float | None, ends_db: tuple[float, float]) -> None:
        """Show the jamming power on the slider.

        Args:
            power_db: of the view, or None without one.
            ends_db: least and greatest that the slider shows.
        """
        if self.power.disabled != (power_db is None):
            self.power.disabled = power_db is None
        if power_db is not None:
            shown = round(2.0 * min(max(power_db, ends_db[0]), ends_db[1])) / 2.0
            if abs(self.power.value - shown) > 1e-9:
                self.power.value = shown


def _show_choice(dropdown: Any, options: tuple[str, ...], chosen: str) -> None:
    if tuple(dropdown.options) != options:
        dropdown.options = options
    if dropdown.value != chosen:
        dropdown.value = chosen
