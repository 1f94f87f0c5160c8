"""Areas on the ground from the features of a geographic file, and whether flying in them is allowed."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain, count

import shapely
from shapely import Polygon

from nullpose.files import PlainTable
from nullpose.scenario.altitude_limits import Ground, altitude_limits
from nullpose.scenario.faults import EXCHANGED, call_each, raise_all, require
from nullpose.scenario.geo_file import NAMES, Feature
from nullpose.scenario.geodesy import wrapped
from nullpose.scenario.shapes import box_about, connected, corners_of, cut, near, parts_of, sound

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


_LONGEST_NAME, _MOST_WORDS = 80, 6
_LIKE_RADII = re.compile("radi|buffer|diameter|width", re.IGNORECASE)
_PASSED_OVER = (
    "fence",
    "permission",
    "point",
    "line",
    "polygon",
    "wall",
    "feature without a place",
    "other feature",
)


@dataclass(slots=True)
class Area:
    """What a feature covers.

    Args:
        place: the feature in its file.
        name: as stated, and unique; empty without one.
        polygons: of the ground, holes and all.
        cylinders: longitude, latitude and radius in metres, each.
        limits: altitudes by the key of a zone.
        remarks: on what of it is not read.
        role: whether flying is allowed in it.
        unknown: words that may say so, and are not known.
    """

    place: str
    name: str
    polygons: list[Polygon]
    cylinders: list[tuple[float, float, object]]
    limits: PlainTable = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)
    role: str = UNSTATED
    unknown: list[str] = field(default_factory=list)

    def zones(self) -> Iterator[PlainTable]:
        """Yield raw no-fly zones, holes filled."""
        shapes: list[PlainTable] = [
            *({"polygon_lat_lon_deg": corners_of(polygon.exterior)} for polygon in self.polygons),
            *({"centre_lat_lon_deg": [lat, lon], "radius_m": size} for lon, lat, size in self.cylinders),
        ]
        for index, shape in enumerate(shapes, 1):
            name = f"{self.name} ({index})" if len(shapes) > 1 else self.name
            yield ({"name": name} if self.name else {}) | shape | self.limits

    def cut(self, box: Polygon) -> bool:
        """Leave out what lies outside a box of degrees; return whether anything is left."""
        self.polygons = [part for polygon in self.polygons for part in cut(polygon, box)]
        self.cylinders = [cylinder for cylinder in self.cylinders if box_about(*cylinder).intersects(box)]
        return bool(self.polygons or self.cylinders)


def account(head: str, counts: Mapping[str, int], parts: Mapping[str, object]) -> str:
    """Say in a line what is read of a file, what is passed over, and what else applies.

    Args:
        head: the first part.
        counts: of features by what became of them.
        parts: the last ones, by whether they apply.
    """
    passed = counted({kind: counts.get(kind, 0) for kind in _PASSED_OVER})
    whole = {f"passed over: {passed}": passed, **parts}
    return "; ".join([head, *(words for words, is_so in whole.items() if is_so)])


def notes_on(
    areas: Sequence[Area], counts: Counter[str], remarks: Sequence[str], *, is_fence: bool = False
) -> Iterator[str]:
    """Say in a line what became of all features of a file, then in a line each kind of remark.

    Args:
        areas: within reach.
        counts: of features by what became of them.
        remarks: on all of them.
        is_fence: whether they are a fence, whose holes are zones; no line where there is nothing to say.
    """
    polygons = polygons_of(areas)
    shapes = counted({"polygon": len(polygons), "cylinder": sum(len(area.cylinders) for area in areas)})
    holes = sum(len(polygon.interiors) for polygon in polygons)
    limits = areas[0].limits if is_fence else {}
    head = f"fence: {shapes}" if is_fence else f"zones: {len(areas)} of {counts['area']} in reach"
    head += f" ({shapes})" if areas and not is_fence else ""
    unknown = list(dict.fromkeys(word for area in areas for word in area.unknown))
    parts = {
        EXCHANGED: counts["area"] and not areas,
        f"holes {'that are zones' if is_fence else 'filled'}: {holes}": holes,
        f"not known to allow or to forbid: {', '.join(unknown[:_MOST_WORDS])}"
        f"{' ...' * (len(unknown) > _MOST_WORDS)}": unknown,
        f"borders that cross, all inside counts: {counts['crossing']}": counts["crossing"],
        ", ".join(f"{key} = {ends}" for key, ends in limits.items()): limits,
    }
    if (words := account(head, counts, parts)) != head or not is_fence:
        yield words
    yield from remarks
    for remark in dict.fromkeys(remark for area in areas for remark in area.remarks):
        first, *others = [area.name or area.place for area in areas if remark in area.remarks]
        yield f'"{first}"{f" (and so {len(others)} more)" if others else ""} {remark}'


def polygons_of(areas: Sequence[Area]) -> list[Polygon]:
    """List the polygons of all areas."""
    return [polygon for area in areas for polygon in area.polygons]


def counted(numbers: Mapping[str, int]) -> str:
    """Put counts by their nouns into words: ``5 points, 1 line``; without those that are 0."""
    plurals = {noun: noun.replace("feature", "features") if " " in noun else f"{noun}s" for noun in numbers}
    return ", ".join(
        f"{number} {plurals[noun] if number > 1 else noun}" for noun, number in numbers.items() if number
    )


def areas_of(
    features: Sequence[Feature],
    reach: Polygon,
    ground_m: Ground,
    names: set[str] | None = None,
    *,
    fence: bool | None = None,
) -> tuple[list[Area], Counter[str], list[str]]:
    """Find the areas of features: polygons, closed lines, and points with a radius.

    The parts of a feature are united; walls, which cover no ground, are left out. An area out of reach is
    counted and left out, and so is one of a file of zones in which flying is allowed.

    Args:
        features: of a file.
        reach: the box of degrees in which areas count.
        ground_m: the origin's ground.
        names: that are taken.
        fence: of zones, whether the airspace has a fence, without which none may be among them; None of the
            file of a fence, in which every crossing of a border is a fault. A zone may have small ones.

    Returns:
        The areas within reach, counts of features by what became of them, and remarks on all of them.

    Raises:
        ScenarioError: with the faults of all features.
    """
    counts, taken = Counter[str](), set(names or ())

    def whole_area(feature: Feature) -> list[Area]:
        role, words, unknown = role_of(feature)
        is_kept = fence is None or role in (STAY_OUT, UNSTATED)
        require(
            is_kept or fence or role == FREE,
            feature.place,
            f"it is {role} ({words}), not out of; name its file in geofence_from, too or instead",
        )
        counts["permission" if role == FREE else "fence"] += not is_kept
        found = area_of(feature, reach, counts, fence is None) if is_kept else []
        for area in found:
            area.role, area.unknown = role, unknown
            area.limits, area.remarks = altitude_limits(
                feature, ground_m, is_fence=fence is None and role != STAY_OUT
            )
            area.name = unique(area.name, taken)
        return found

    areas, faults = call_each(whole_area, chain.from_iterable(map(_pieces, features)))
    raise_all(faults)
    keys = {key for each in features for key in each.properties if _LIKE_RADII.search(key)} - {"radius_m"}
    unread = f"{', '.join(sorted(keys))} is not read; a radius is radius_m, of a point"
    return list(chain.from_iterable(areas)), counts, [unread] if keys else []


def _pieces(feature: Feature) -> list[Feature]:
    """Return a feature of KML once for each solid that it may hold, with its own heights."""
    pieces = connected(feature.geometry) if "altitudeMode" in feature.properties else []
    return [replace(feature, geometry=piece) for piece in pieces] or [feature]


def area_of(feature: Feature, reach: Polygon, counts: Counter[str], is_fence: bool) -> list[Area]:
    """Find what a feature covers within reach; count what it is.

    Args:
        feature: of a file.
        reach: the box of degrees in which areas count.
        counts: of features by what became of them, which are raised.
        is_fence: whether every crossing of a border is a fault.

    Returns:
        The area without altitudes; nothing without one.

    Raises:
        ScenarioError: its border crosses itself.
    """
    middle_deg, polygons, cylinders = reach.centroid.x, list[Polygon](), []
    parts = list(parts_of(shapely.force_2d(feature.geometry)))
    counts["feature without a place"] += not parts
    extent = feature.properties.get("extent")  # by ED-318
    radius_m = feature.properties.get("radius_m", extent.get("radius") if isinstance(extent, dict) else None)
    for part in parts:
        if part.geom_type == "Point" and radius_m is not None:
            cylinders.append((float(wrapped(part.x, middle_deg)), part.y, radius_m))
        elif part.geom_type == "Point":
            counts["point"] += 1
        elif part.geom_type == "LineString" and not (part.is_closed and len(part.coords) > 3):
            counts["line"] += 1
        else:
            polygons.append(
                near(part if part.geom_type == "Polygon" else shapely.Polygon(part.coords), middle_deg)
            )
    within = [polygon for polygon in polygons if polygon.envelope.intersects(reach)]
    checked = [sound(polygon, feature.place, is_fence) for polygon in within]
    counts["crossing"] += sum(is_crossing for _, is_crossing in checked)
    ground = [polygon for polygon, _ in checked if polygon.area]
    is_wall = within and not ground and not cylinders
    counts["wall" if is_wall else "area"] += 1 if polygons or cylinders else 0
    united = list(parts_of(shapely.union_all(ground) if len(ground) > 1 else ground))
    area = Area(feature.place, name_of(feature), united, cylinders)
    return [area] if area.cut(reach) else []


def name_of(feature: Feature) -> str:
    """Return a feature's name on one line, however it is stated; empty without one."""
    value = next((feature.properties[key] for key in NAMES if key in feature.properties), "")
    if isinstance(value, list) and value and isinstance(value[0], dict):
        value = value[0].get("text", "")  # ED-318 has one for each language
    words = " ".join(str(value).split())
    return "".join(letter for letter in words if letter.isprintable())[:_LONGEST_NAME].strip()


def unique(name: str, taken: set[str]) -> str:
    """Number a name that is taken, and take it; an empty one stays."""
    if not name:
        return ""
    name = next(each for each in (f"{name} {n}" if n > 1 else name for n in count(1)) if each not in taken)
    taken.add(name)
    return name
