"""Whether a feature of a file allows flying in it or forbids it: the few words that decide."""

from __future__ import annotations

import re

from nullpose.scenario.faults import require
from nullpose.scenario.geo_file import Feature

STAY_IN, FREE, STAY_OUT = "an area to stay in", "an area where flying is allowed", "an area to stay out of"
"""What a feature may say of flying in it."""
UNSTATED = "an area"
"""What it is if it says nothing of that."""

_YES, _NO, _NEUTRAL = ("true", "yes", "1", "1.0"), ("false", "no", "0", "0.0"), ("common", "customized")
_SENSES = (  # of keys: what yes means, and what no
    (("inclusion", "inclusive", "included", "keepin", "stayin"), STAY_IN, STAY_OUT),
    (("exclusion", "exclusive", "excluded", "keepout", "stayout"), STAY_OUT, STAY_IN),
    (("nofly", "noflyzone", "nfz", "prohibited", "forbidden", "restricted"), STAY_OUT, FREE),
    (("allowed", "permitted", "flyingallowed", "flightallowed"), FREE, STAY_OUT),
)
_WORDS = (
    {word: role for words, role, _ in _SENSES for word in words}
    | {f"{key}{word}": role for keys, role, _ in _SENSES for key in keys for word in _YES}
    | {f"{key}{word}": role for keys, _, role in _SENSES for key in keys for word in _NO}
    | dict.fromkeys(
        ("danger", "conditional", "reqauthorisation", "reqauthorization", "kindbuilding"), STAY_OUT
    )
    | dict.fromkeys(("norestriction", "norestrictions", "unrestricted", "allow", "granted"), FREE)
    | dict.fromkeys(("restrictionnone", "restrictionsnone", "restrictionno", "restrictionfalse"), FREE)
    | dict.fromkeys(("kindgeofence", "kindairspace"), STAY_IN)  # as nullpose exports them
)
"""The role by a value, or by a key with its value, in small letters alone."""
_DECIDES = re.compile(
    "type$|kind$|restrict(?!ioncond)|prohib|forbid|fence|zone$|inclu|exclu|keep|stay|nofly|nfz|allow|permi|flyable"
)
_MAY_DECIDE = re.compile(f"{_DECIDES.pattern}|categor|class|status|rule|variant|usage|fly|flight|mode|action")


def role_of(feature: Feature) -> tuple[str, str, list[str]]:
    """Read whether flying is allowed in a feature.

    Returns:
        One of the four roles, the words that say so, and those that look like it and are not known.

    Raises:
        ScenarioError: two words contradict each other.
    """
    roles, unknown = dict[str, str](), list[str]()
    for key, value in feature.properties.items():
        name, word = re.sub("[^a-z]", "", key.lower()).removeprefix("is"), str(value).lower()
        role = _WORDS.get(re.sub("[^a-z]", "", word)) or _WORDS.get(f"{name}{word}")
        if role and _MAY_DECIDE.search(name):
            roles[role] = f"{key} = {value}"
        elif _DECIDES.search(name) and word not in _NEUTRAL and not isinstance(value, dict):
            unknown.append(f"{key} = {value}"[:60])
    require(
        roles.keys() <= {STAY_IN, FREE} or len(roles) == 1,
        feature.place,
        f"{' and '.join(roles.values())} contradict each other: is it to be stayed in or out of? Keep one",
    )
    role = STAY_IN if STAY_IN in roles else next(iter(roles), UNSTATED)
    return role, roles.get(role, ""), unknown
