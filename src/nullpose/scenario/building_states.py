"""Whether a building of a file is there, and whether it hides what is behind it, as such files state it."""

from __future__ import annotations

import re

from nullpose.scenario.geo_file import Feature

GONE = {
    *("underground", "undergr", "demolished", "razed", "removed", "destroyed", "dismantled", "proposed"),
    *("planned", "was"),
}
"""What is said of buildings that are not there, in OpenStreetMap, Overture and a shapefile's short names."""
ON_POSTS = {"roof", "carport", "canopy", "bridge"}
"""What is said of buildings that are open from the ground up to a base, which they may state."""
OPEN = {*ON_POSTS, "construction", "ruins", "collapsed", "parts"}
"""What is said of buildings that may be open at any height, or lower where their parts are."""
MARK = re.compile(rf"(?:({'|'.join(sorted(GONE | OPEN))}|abandoned|disused):)?building(?::part)?")
"""What OpenStreetMap marks buildings with, of today and of other days."""
_BELOW = r"-\d+(?:\.\d+)?(?:;-\d+)*"  # levels, all below the ground


def state_of(feature: Feature) -> str:
    """Say why a building is not there, or may be open from the ground up; nothing if neither is stated.

    Args:
        feature: of a file.
    """
    properties = feature.properties
    words = {
        str(value).lower()
        for value in map(properties.get, ("building", "building:part", "class", "location", "status"))
    }
    words |= {
        flag.removeprefix("is_").removeprefix("has_")
        for flag in {key.lower() for key, value in properties.items() if value in ("yes", "true", True)}
    }
    if properties.keys().isdisjoint(("building", "building:part")):
        words |= {mark[1] for mark in map(MARK.fullmatch, properties) if mark}
    if any(re.fullmatch(_BELOW, str(properties.get(key))) for key in ("layer", "level")):
        words.add("underground")
    return next(iter([*sorted(words & GONE), *sorted(words & OPEN)]), "")
