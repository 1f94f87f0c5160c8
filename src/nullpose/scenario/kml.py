"""The placemarks of KML: each with its geometries, and what every one of them says of its heights."""

from __future__ import annotations

import io
import re
import zipfile
import zlib
from collections.abc import Iterator
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from nullpose.files import PlainTable
from nullpose.scenario.faults import refusal, require

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_PLACE = re.compile(rf"{_NUMBER},{_NUMBER}(?:,(?:{_NUMBER})?)?")
_SIDES = ("outerBoundaryIs", "innerBoundaryIs")
_CHAINS = ("Point", "LineString", "LinearRing", "Track")
_OF_PLACEMARK = ("{*}name", "{*}description", "{*}TimeSpan/*", "{*}TimeStamp/*")
_DATA = ("{*}ExtendedData/*", "{*}ExtendedData/{*}SchemaData/*")


def kml_of_kmz(content: bytes, most: int) -> bytes:
    """Unpack the one KML document of an archive."""
    names, found = [], b""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            names = [name for name in archive.namelist() if name.lower().endswith(".kml")]
            for name in names[:1]:
                with archive.open(name) as file:
                    found = file.read(most + 1)
    except (
        zipfile.BadZipFile,
        zlib.error,
        EOFError,
        OSError,
        NotImplementedError,
        RuntimeError,
        ValueError,
    ) as error:
        raise refusal(
            "", f"this is not KMZ: {str(error) or 'it ends early'}; export it anew, or as .kml"
        ) from None
    require(len(names) == 1, "", f"it has {len(names)} KML files, must be one; extract the one that counts")
    require(len(found) <= most, "", f"its KML is larger than {most / 1e6:g} MB, the most that is read")
    return found


def root_of(content: bytes, kind: str) -> Element:
    """Return the root of an XML document of a kind."""
    try:
        root = ElementTree.fromstring(b"" if b"<!DOCTYPE" in content else content)
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise refusal("", f"this is not {kind.upper()}: {error}; export it anew") from None
    require(root.tag.endswith(kind), "", f"its root is {root.tag!r}, must be {kind!r}")
    return root


def placemarks_of(root: Element) -> Iterator[tuple[str, PlainTable | None, PlainTable]]:
    """Yield each placemark's place in the file, a geometry as in GeoJSON, and its texts by name.

    A placemark is there once for each ``altitudeMode`` of its geometries, and once for each that is extruded:
    what is yielded together states one thing of its heights. A coordinate without one has NaN.

    Args:
        root: of the document.

    Raises:
        ScenarioError: there is something else that may hold areas, or a coordinate cannot be read.
    """
    for kind, words in (("NetworkLink", "a link to another file"), ("GroundOverlay", "a picture on a map")):
        require(
            root.find(f".//{{*}}{kind}") is None,
            "",
            f"it has a {kind}, {words}, which is not read; save what it shows as KML",
        )
    for number, placemark in enumerate(root.iterfind(".//{*}Placemark")):
        name = placemark.findtext("{*}name", "").strip()
        place = f'Placemark "{name}"' if name else f"Placemark[{number}]"
        texts = {_kind(each): each.text for path in _OF_PLACEMARK for each in placemark.iterfind(path)} | {
            each.get("name", _kind(each)): each.findtext("{*}value", each.text)
            for path in _DATA
            for each in placemark.iterfind(path)
        }
        groups: dict[tuple[str, int], list[PlainTable]] = {}
        for index, (mode, is_extruded, shape) in enumerate(_members(placemark, place)):
            groups.setdefault((mode, index if is_extruded else -1), []).append(shape)
        for (mode, index), shapes in groups.items():
            heights = {"altitudeMode": mode, "extrude": "1" if index >= 0 else ""}
            yield place, {"type": "GeometryCollection", "geometries": shapes}, texts | heights
        if not groups:
            yield place, None, texts


def _members(parent: Element, place: str) -> Iterator[tuple[str, bool, PlainTable]]:
    """Yield the altitudeMode, whether it is extruded, and the shape of each geometry of a placemark."""
    for each in parent:
        kind, is_polygon = _kind(each), _kind(each) == "Polygon"
        if kind in ("MultiGeometry", "MultiTrack"):
            yield from _members(each, place)
            continue
        rings = [ring for side in _SIDES for ring in each.iterfind(f"{{*}}{side}/{{*}}LinearRing")]
        chains = rings if is_polygon else [each] * (kind in _CHAINS)
        lines = [line for chain in chains if (line := list(_corners(chain, place)))]
        require(
            len(each.findall(".//{*}coordinates"))
            == sum(len(each.findall("{*}coordinates")) for each in chains)
            and len(each.findall("{*}outerBoundaryIs")) == is_polygon,
            place,
            f"its {kind} has coordinates that are not read, or is without its outerBoundaryIs; export anew",
        )
        if lines:
            kind = "Polygon" if is_polygon else "LineString" if lines[0][1:] else "Point"
            corners = {"Polygon": lines, "LineString": lines[0], "Point": lines[0][0]}[kind]
            mode, extrude = (each.findtext(f"{{*}}{key}", "").strip() for key in ("altitudeMode", "extrude"))
            yield mode, is_polygon and extrude in ("1", "true"), {"type": kind, "coordinates": corners}


def _corners(chain: Element, place: str) -> Iterator[list[float]]:
    """Yield longitude, latitude and height of each corner of a chain; NaN where none is written."""
    written = [each for text in chain.iterfind("{*}coordinates") for each in (text.text or "").split()]
    for each in [*written, *(",".join((step.text or "").split()) for step in chain.iterfind("{*}coord"))]:
        require(
            _PLACE.fullmatch(each), place, f'got "{each[:60]}", must be longitude,latitude without blanks'
        )
        yield [float(number or "nan") for number in f"{each},".split(",")[:3]]


def _kind(element: Element) -> str:
    return element.tag.rpartition("}")[2]
