"""The least tilt that a scene needs: both sides for each mount, and the answer in words."""

from __future__ import annotations

from nullpose.objectives import Quantity
from nullpose.report.document import View, cell, document, head, rows, table
from nullpose.study.least_tilt import LeastTilt, MountTilt

_AN_ANTENNA = "An antenna mounted at {0.mount_deg:.4g} degrees needs"
_NO_TILT = f"{_AN_ANTENNA} no tilt: a level vehicle suffices."
_NEEDS = {  # whether a tilt is known that is too little, and one that suffices
    (True, True): _AN_ANTENNA
    + " more than {0.fails_deg:.1f} degrees of tilt; {0.suffices_deg:.1f} degrees suffice.",
    (True, False): _AN_ANTENNA + " more than {0.fails_deg:.1f} degrees of tilt.",
    (False, True): _AN_ANTENNA + " at most {0.suffices_deg:.1f} degrees of tilt.",
    (False, False): "Of an antenna mounted at {0.mount_deg:.4g} degrees neither is known: what suffices, nor "
    "what is too little.",
}


def vehicle_view(found: LeastTilt) -> View:
    """Set a row for each mount, and what it takes in words."""
    quantity = found.omnidirectional.objective.quantity
    mounts = [*found.mounts, *([] if found.best is None else [found.best])]
    cells = rows(
        {
            "mount (deg)": [
                f"{each.mount_deg:.4g}{' best' if each is found.best else ''}" for each in mounts
            ],
            "least tilt (deg)": [cell(each.suffices_deg, ".1f") for each in mounts],
            f"value ({quantity.unit})": [_value(quantity, each.value) for each in mounts],
            "too little (deg)": [cell(each.fails_deg, ".1f") for each in mounts],
            f"bound there ({quantity.unit})": [_value(quantity, each.upper_bound) for each in mounts],
        }
    )
    whole, target = (_value(quantity, each) for each in (found.omnidirectional.objective.value, found.target))
    kind = "" if quantity.is_rate else " (as a power ratio)"
    lines = [
        f"Target: {target} {quantity.unit}, {100.0 * found.share:.6g} %{kind} of the bound on the "
        f"{quantity.smallest} with any attitude, where {whole} {quantity.unit} are reached.",
        "Mount: angle between the antenna and the body's vertical, 0 upright, 90 flat. Yaw is free, and each "
        "mount has its own best position.",
        "Least tilt: a pose with it reaches the target. Too little: no pose with it reaches that share of "
        "the value.",
        *(
            ["The errors that the file states are not considered."]
            if found.omnidirectional.scenario.is_uncertain
            else []
        ),
        f"Bounds: {found.rigour.message}.",
    ]
    return document(
        head(found.omnidirectional.scenario.name),
        "",
        table("Tilt that suffices", cells),
        "\n".join(lines),
        "",
        head(answer(found)),
    )


def answer(found: LeastTilt) -> str:
    """Say in a sentence or two what vehicle suffices, of those with the mounts that were looked at."""
    sentences = [_sentence(mount) for mount in found.mounts]
    if found.best is not None:
        needs = _sentence(found.best)
        least = f"With the antenna mounted at {found.best.mount_deg:.4g} degrees, a level vehicle suffices"
        sentences.append(
            f"{least} for this scene."
            if found.best.suffices_deg == 0.0
            else f"Of all mounts looked at, {needs[:1].lower()}{needs[1:]}"
        )
    return "\n".join(sentences)


def _sentence(mount: MountTilt) -> str:
    is_known = mount.fails_deg is not None, mount.suffices_deg is not None
    words = (_NO_TILT if mount.suffices_deg == 0.0 else _NEEDS[is_known]).format(mount)
    return f"{words} The rest is open: {mount.reason}." if mount.reason else words


def _value(quantity: Quantity, value: float | None) -> str | None:
    return None if value is None else f"{quantity.in_unit(value):.4f}"
