"""A scene as a text that fits into an address, and back."""

from __future__ import annotations

import zlib
from base64 import urlsafe_b64encode
from binascii import a2b_base64

from nullpose.errors import Fault, ScenarioError, UsageError
from nullpose.scenario import Scenario
from nullpose.scenario.loading import scenario_from_text

SCENE = "the scene in the address"
"""What such a scene is called in messages."""

_MOST_BYTES = 1_000_000
_MOST_CHARACTERS = 7_800  # the websockets library takes a request line of 8192 bytes


def scene_to_text(scenario: Scenario) -> str:
    """Return a scenario as a text of letters, digits, hyphens and underscores.

    Args:
        scenario: which.

    Raises:
        UsageError: the text is too long for an address.
    """
    text = urlsafe_b64encode(zlib.compress(scenario.to_toml().encode(), 9)).decode().rstrip("=")
    if len(text) > _MOST_CHARACTERS:
        raise UsageError(
            f"this scene is too large for an address: {len(text)} characters, at most {_MOST_CHARACTERS}; "
            "save it as a file instead"
        )
    return text


def scenario_from_scene(text: str) -> Scenario:
    """Return the scenario that a text from an address stands for.

    Args:
        text: as :func:`scene_to_text` returns it.

    Raises:
        ScenarioError: it stands for none, or for a file over 1 MB.
    """
    inflater = zlib.decompressobj()
    try:
        plain = text.translate({ord("-"): "+", ord("_"): "/"})
        packed = a2b_base64(plain + "=" * (-len(plain) % 4), strict_mode=True)
        content = inflater.decompress(packed, _MOST_BYTES)
    except (ValueError, zlib.error):
        content = b""
    if not inflater.eof:
        raise ScenarioError(
            [Fault("scene", "it is damaged, cut off, or over 1 MB; copy the link again")], SCENE
        )
    return scenario_from_text(content, SCENE)
