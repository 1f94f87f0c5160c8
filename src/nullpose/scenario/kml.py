"""What GDAL does not say of KML: whether it reads all that a document holds."""

from __future__ import annotations

import io
import re
import zipfile
import zlib
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from nullpose.scenario.faults import refusal, require

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_PLACE = re.compile(rf"{_NUMBER},{_NUMBER}(?:,(?:{_NUMBER})?)?")


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


def require_whole(root: Element, placemarks: int, corners: int) -> None:
    """Refuse a KML document of which GDAL reads a part only, or another place than is written.

    Args:
        root: of the document.
        placemarks: that GDAL reads.
        corners: of all of them.

    Raises:
        ScenarioError: there are more, or something else that may hold areas.
    """
    for kind, words in (("NetworkLink", "a link to another file"), ("GroundOverlay", "a picture on a map")):
        require(
            root.find(f".//{{*}}{kind}") is None,
            "",
            f"it has a {kind}, {words}, which is not read; save what it shows as KML",
        )
    written = root.findall(".//{*}Placemark")
    count = 0
    for placemark in written:
        for place in " ".join(each.text or "" for each in placemark.findall(".//{*}coordinates")).split():
            count += 1
            if not _PLACE.fullmatch(place):
                name = f'Placemark "{placemark.findtext("{*}name", "").strip()}"'
                raise refusal(name, f'got "{place[:60]}", must be longitude,latitude without blanks')
    require(
        placemarks == len(written) and corners >= count,
        "",
        f"GDAL reads {placemarks} placemarks with {corners} coordinates, and it has {len(written)} with "
        f"{count}; is a polygon without its outerBoundaryIs, or a LinearRing by itself? Export it anew",
    )
