"""The panel's numbers as HTML: status, value and bound, nodes, pose."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape

from nullpose.errors import ScenarioError
from nullpose.report.geometry import null_angle_rad
from nullpose.studio.answer import Answer, Stage
from nullpose.studio.colours import SLOTS, css
from nullpose.studio.session import Session

__all__ = ["about_html", "drone_text", "failure_html", "readout_html", "status_tone"]

_TONES = {"waiting": "#8a5a00", "found": "#005a8c", "proved": "#00684a", "failed": "#a02000"}
_MARKS = {"waiting": "&#8987;", "found": "&#9679;", "proved": "&#10003;", "failed": "&#10007;"}
_STYLE = "font-size:13px;line-height:1.35;padding:2px 10px 8px;font-variant-numeric:tabular-nums"

_ABOUT = """<b>A drone listens to ground nodes while jammers drown them.</b> Its antenna, a short dipole,
hears nothing along its own axis: the <b>null</b>. nullpose finds where to hover and how to tilt so that the
worst-off node is heard best, and proves that no other pose does better.
<ul style="margin:4px 0 4px 16px;padding:0">
<li>Blue boxes: nodes; orange spikes: jammers. Drag their arrows.</li>
<li>Doughnut: what the antenna hears; orange line: the null.</li>
<li>Lines: brighter is a better SINR; the thick one decides.</li>
<li>Carpet: the best that each place at this altitude could give.</li></ul>"""


def about_html() -> str:
    """Return what a newcomer is looking at."""
    return f'<div data-np="about" style="{_STYLE};font-size:12.5px">{_ABOUT}</div>'


def status_tone(session: Session, answer: Answer | None, status: str) -> str:
    """Return the tone of a status: waiting, found, proved or failed.

    Args:
        session: has the present version.
        answer: the answer that is shown, or None.
        status: in words.
    """
    if status.startswith("no pose"):
        return "failed"
    if answer is None or not session.is_current(answer):
        return "waiting"
    return "proved" if answer.stage is Stage.CERTIFIED else "found"


def readout_html(session: Session) -> str:
    """Return the numbers of every case that is shown, greyed where they are not of the present scene.

    Args:
        session: whose.
    """
    view = session.view
    blocks = [_case_html(session, slot) for slot in range(len(view.cases))]
    if view.compared is not None:
        blocks.append(_difference_html(session))
    return f'<div data-np="readout" data-version="{session.version}" style="{_STYLE}">{"".join(blocks)}</div>'


def _case_html(session: Session, slot: int) -> str:
    case = session.view.cases[slot]
    answer, status = session.answer(case), session.status(case)
    tone = status_tone(session, answer, status)
    letter = f"{'AB'[slot]}: " if session.view.compared is not None else ""
    head = (
        f'<div style="font-weight:600;color:{css(SLOTS[slot])}">{letter}{escape(case.label)}</div>'
        f'<div data-np="status-{slot}" style="color:{_TONES[tone]};font-weight:600">'
        f"{_MARKS[tone]} {escape(status)}</div>"
    )
    if answer is None or tone == "failed":
        return head
    shade = "" if session.is_current(answer) else "opacity:.4;"
    return (
        f'{head}<div data-np="numbers-{slot}" data-version="{answer.version}" style="{shade}">'
        f"{_numbers(answer, slot)}</div>"
    )


def _numbers(answer: Answer, slot: int) -> str:
    quantity = answer.quantity
    words = (
        f"guaranteed {quantity.noun}"
        if answer.case.robust and answer.bound is not None
        else quantity.smallest
    )
    bound = answer.shown_bound
    proved = "" if bound is None else f" &le; {_signed(bound, 4)}"
    value = (
        f'{escape(words)} <b data-np="value-{slot}" data-value="{answer.value!r}">'
        f"{_signed(answer.shown_value, 4)}</b>{proved} {quantity.unit}"
    )
    return f"<div>{value}</div>{_nodes(answer)}{_pose(answer, slot)}{_note(answer)}"


def _nodes(answer: Answer) -> str:
    rows = []
    for link in answer.links:
        binding = link.node == answer.binding_node
        rate = link.secrecy_rate_bps_hz
        own = f"{_signed(link.sinr_db)} dB" + ("" if rate is None else f", {rate:.3f} bits/s/Hz")
        mark = " &#9664; decides" if binding else ""
        weight = "600" if binding else "400"
        rows.append(
            f'<span style="font-weight:{weight};white-space:nowrap">{escape(link.node)} {own}{mark}</span>'
        )
    return f'<div style="display:flex;flex-wrap:wrap;gap:0 12px">{"".join(rows)}</div>'


def _pose(answer: Answer, slot: int) -> str:
    pose = answer.pose
    east, north, up = pose.position_m
    angles = [math.degrees(x) for x in (pose.roll_rad, pose.pitch_rad, pose.yaw_rad, pose.tilt_rad)]
    roll, pitch, yaw, tilt = (_signed(angle, 1) for angle in angles)
    null = [
        f"{math.degrees(null_angle_rad(pose, jammer.position_m)):.1f}&deg; off {escape(jammer.name)}"
        for jammer in answer.scenario.jammers
    ]
    text = (
        f'at <span data-np="position-{slot}">{_signed(east)}, {_signed(north)}, {_signed(up)}</span> m '
        f"(east, north, up)<br>roll {roll}&deg;, pitch {pitch}&deg;, yaw {yaw}&deg; (tilt {tilt}&deg;)"
    )
    return f"<div>{text}{'<br>null ' + ', '.join(null[:4]) if null else ''}</div>"


def _note(answer: Answer) -> str:
    return f'<div style="color:#555;font-size:12px">{escape(answer.note)}</div>' if answer.note else ""


def _difference_html(session: Session) -> str:
    first, second = (session.answer(case) for case in session.view.cases)
    if first is None or second is None or not (session.is_current(first) and session.is_current(second)):
        return ""
    if any(answer.case.robust and answer.bound is None for answer in (first, second)):
        return ""  # what it guarantees is not known yet
    difference = _signed(first.shown_value - second.shown_value)
    unlike = ""
    if first.case.robust != second.case.robust:
        robust, other = "AB" if first.case.robust else "BA"
        unlike = f" ({robust} guaranteed, {other} without errors)"
    return f'<div data-np="difference"><b>A over B: {difference} {first.quantity.unit}</b>{unlike}</div>'


def failure_html(error: ScenarioError | None, name: str = "") -> str:
    """Return the faults of a scenario as a list, each with its path; nothing without an error.

    Args:
        error: what was wrong, or None.
        name: what was refused.
    """
    if error is None:
        return '<div data-np="faults"></div>'
    rows: Sequence[str] = [
        f"<li><code>{escape(fault.path or 'the whole file')}</code>: {escape(fault.message)}</li>"
        for fault in error.faults
    ]
    return (
        f'<div data-np="faults" style="{_STYLE};color:{_TONES["failed"]}"><b>{escape(name)} was not taken</b>'
        f'<ul style="margin:2px 0 2px 16px;padding:0;overflow-wrap:anywhere">{"".join(rows)}</ul></div>'
    )


def _signed(number: float, digits: int = 2) -> str:
    text = f"{number:.{digits}f}"
    if float(text) == 0.0:
        text = text.lstrip("-")
    return text.replace("-", "&minus;").replace("inf", "&infin;")


def drone_text(session: Session, slot: int) -> str:
    """Return a drone's label: its letter where two are compared, its value and how well it is known.

    Args:
        session: whose.
        slot: 0 for the chosen case, 1 for the compared one.
    """
    view = session.view
    case = view.cases[slot]
    answer = session.answer(case)
    letter = f"{'AB'[slot]}: " if view.compared is not None else ""
    status = session.status(case)
    if answer is None or not session.is_current(answer):
        return f"{letter}{status}"
    value = f"{answer.shown_value:.2f} {answer.quantity.unit}".replace("-", "\N{MINUS SIGN}")
    return f"{letter}{value}, {status}"
