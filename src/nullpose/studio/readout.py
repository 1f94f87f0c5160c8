"""The panel's numbers as HTML: status, value and bound, nodes, pose."""

from __future__ import annotations

import math
from html import escape

import numpy as np

from nullpose.errors import ScenarioError
from nullpose.report.geometry import null_angle_rad
from nullpose.solver import Result
from nullpose.solver.robust import GuardedPose
from nullpose.studio.answer import Answer, signed
from nullpose.studio.look import DARK, LIGHT, css, either
from nullpose.studio.state import State

_FAILED = "no pose"
_TONES = {
    _FAILED: (either("#a02000", "#ff9b80"), "&#10007;"),
    "certified": (either("#00684a", "#4fd6a6"), "&#10003;"),
    "best so far": (either("#005a8c", "#7cc4f5"), "&#9679;"),
    "": (either("#8a5a00", "#f0b64a"), "&#9675;"),
}
"""Colour and mark of how far a case has come, by how its status begins."""

_NOTE = either("#555", "#b8b8b8")
_MOST_NULLS = 4
_STYLE = "font-size:13px;line-height:1.35;padding:2px 10px 8px;font-variant-numeric:tabular-nums"

_ABOUT = """<b>A drone receives from ground nodes while jammers transmit.</b> Its antenna, a short dipole,
receives nothing along its own axis: the <b>null</b>. nullpose finds the position and the attitude with the
largest smallest SINR over the nodes, and proves an upper bound for all other poses.
<ul style="margin:4px 0 4px 16px;padding:0">
<li>Blue boxes: nodes; orange spikes: jammers. Click one, then drag its arrows; <i>Edit</i> adds more.</li>
<li>Doughnut: the antenna's pattern, open towards you; orange: the null.</li>
<li>Lines: brighter and thicker is a higher SINR; the worst nodes have the largest names.</li>
<li>Coloured ground: how much the antenna receives from there; <i>Map and view</i> has more.</li></ul>"""


def about_html() -> str:
    """Explain the scene to a newcomer."""
    return f'<div data-np="about" style="{_STYLE};font-size:12.5px">{_ABOUT}</div>'


def readout_html(state: State) -> str:
    """Return the numbers of every case that is shown, greyed where they are not of the present scene.

    Args:
        state: of the page.
    """
    blocks = [_case_html(state, slot) for slot in range(len(state.cases))]
    if state.compared is not None:
        blocks.append(_difference_html(state))
    return f'<div data-np="readout" data-version="{state.version}" style="{_STYLE}">{"".join(blocks)}</div>'


def _case_html(state: State, slot: int) -> str:
    case = state.cases[slot]
    answer, current, status = state.answer(case), state.current(case), state.status(case)
    _, colour, mark = status_look(status)
    colour_of_slot = either(*(css(look.slots[slot]) for look in (LIGHT, DARK)))
    head = (
        f'<div style="font-weight:600;color:{colour_of_slot}">{state.letter(slot)}'
        f"{escape(case.label)}</div>"
        f'<div data-np="status-{slot}" style="color:{colour};font-weight:600">{mark} {escape(status)}</div>'
    )
    head += _note(case.left_out(state.scenario))
    if answer is None or status.startswith(_FAILED):
        return head
    shade = "" if answer is current else "opacity:.4;"
    return (
        f'{head}<div data-np="numbers-{slot}" data-version="{answer.version}" style="{shade}">'
        f"{_value(answer, slot)}{_nodes(answer)}{_pose(answer.result, slot)}{_note(answer.note)}</div>"
    )


def status_look(status: str) -> tuple[str, str, str]:
    """Return the look of a status: how it begins, its colour on white, and its mark.

    Args:
        status: in words.
    """
    return next((start, *look) for start, look in _TONES.items() if status.startswith(start))


def _note(text: str) -> str:
    return f'<div style="color:{_NOTE};font-size:12px">{escape(text)}</div>' if text else ""


def _value(answer: Answer, slot: int) -> str:
    objective, quantity = answer.result.objective, answer.result.objective.quantity
    proved = answer.bound_text and f", {answer.bound_text}"
    return (
        f'<div>{escape(answer.value_words)} <b data-np="value-{slot}" data-value="{objective.value!r}">'
        f"{signed(answer.shown_value, 4)}</b>{proved} {quantity.unit}</div>"
    )


def _nodes(answer: Answer) -> str:
    if answer.guarded is not None:
        return _guaranteed_nodes(answer, answer.guarded)
    rows = []
    for link in answer.result.links:
        numbers = f"{signed(link.sinr_db)} dB"
        if link.margin_db is not None:
            numbers += f", margin {signed(link.margin_db)} dB"
        if link.secrecy_rate_bps_hz is not None:
            numbers += f", {link.secrecy_rate_bps_hz:.3f} bits/s/Hz"
        weight, mark = _worst(answer, link.node)
        style = f"font-weight:{weight};white-space:nowrap"
        rows.append(f'<span style="{style}">{escape(link.node)} {numbers}{mark}</span>')
    return f'<div style="display:flex;flex-wrap:wrap;gap:0 12px">{"".join(rows)}</div>'


def _guaranteed_nodes(answer: Answer, guarded: GuardedPose) -> str:
    """Return a table of what each node has without errors and what it is guaranteed."""
    quantity, rows = answer.result.objective.quantity, ""
    for link in answer.result.links:
        lower = min(ratio.lower for ratio in guarded.guarantee.ratios if ratio.node == link.node)
        numbers = (quantity.in_unit(number) for number in (quantity.at(link), quantity.of_ratio(lower)))
        cells = "".join(f'<td style="text-align:right">{signed(number)}</td>' for number in numbers)
        weight, mark = _worst(answer, link.node)
        rows += f'<tr style="font-weight:{weight}"><td>{escape(link.node)}</td>{cells}<td>{mark}</td></tr>'
    heads = "".join(f'<th style="font-weight:400">{head}</th>' for head in ("without errors", "guaranteed"))
    head = f"<tr><th></th>{heads}<th>{quantity.unit}</th></tr>"
    return f'<table data-np="guaranteed" style="border-spacing:12px 0;margin-left:-12px">{head}{rows}</table>'


def _worst(answer: Answer, node: str) -> tuple[int, str]:
    """Return the weight of a node's letters and the mark behind it."""
    return (600, " &#9664; worst") if node in answer.worst_nodes else (400, "")


def _pose(result: Result, slot: int) -> str:
    pose = result.pose
    east, north, up = map(signed, pose.position_m)
    angles = np.degrees([pose.roll_rad, pose.pitch_rad, pose.yaw_rad, pose.tilt_rad])
    roll, pitch, yaw, tilt = (signed(angle, 1) for angle in angles)
    null = ", ".join(
        f"{math.degrees(null_angle_rad(pose, jammer.position_m)):.1f}&deg; off {escape(jammer.name)}"
        for jammer in result.scenario.jammers[:_MOST_NULLS]
    )
    if not result.scenario.antenna_record.is_quadratic:
        null = ""  # its nulls are where the pattern has them
    return (
        f'<div>at <span data-np="position-{slot}">{east}, {north}, {up}</span> m (east, north, up)<br>'
        f"roll {roll}&deg;, pitch {pitch}&deg;, yaw {yaw}&deg; (tilt {tilt}&deg;){null and '<br>null '}{null}"
        "</div>"
    )


def _difference_html(state: State) -> str:
    first, second = map(state.current, state.cases)
    if first is None or second is None:
        return ""
    if any(answer.case.robust and answer.guarded is None for answer in (first, second)):
        return ""  # what it guarantees is not known yet
    unlike = ""
    if first.case.robust != second.case.robust:
        robust, other = "AB" if first.case.robust else "BA"
        unlike = f" ({robust} guaranteed, {other} without errors)"
    difference = signed(first.shown_value - second.shown_value)
    unit = first.result.objective.quantity.unit
    return f'<div data-np="difference"><b>A over B: {difference} {unit}</b>{unlike}</div>'


def failure_html(error: ScenarioError | None, name: str = "") -> str:
    """Return the faults of a scenario as a list, each with its path; nothing without an error.

    Args:
        error: what was wrong, or None.
        name: what was refused.
    """
    if error is None:
        return '<div data-np="faults"></div>'
    rows = [
        f"<li><code>{escape(fault.path or 'the whole file')}</code>: {escape(fault.message)}</li>"
        for fault in error.faults
    ]
    style = f"{_STYLE};color:{_TONES[_FAILED][0]}"
    return (
        f'<div data-np="faults" style="{style}"><b>{escape(name)} was not taken</b>'
        f'<ul style="margin:2px 0 2px 16px;padding:0;overflow-wrap:anywhere">{"".join(rows)}</ul></div>'
    )


def tool_html(words: str) -> str:
    """Write what the next click on the ground does.

    Args:
        words: a sentence; empty if it adds nothing.
    """
    return f'<div data-np="tool" style="{_STYLE if words else ""};font-weight:600">{escape(words)}</div>'


def drone_text(state: State, slot: int) -> str:
    """Return a drone's label: its letter where two are compared, its value and how well it is known.

    Args:
        state: of the page.
        slot: 0 for the chosen case, 1 for the compared one.
    """
    case = state.cases[slot]
    answer, value = state.current(case), ""
    if answer is not None:
        unit = answer.result.objective.quantity.unit
        value = f"{signed(answer.shown_value)} {unit}, "
    return f"{state.letter(slot)}{value}{state.status(case)}"
