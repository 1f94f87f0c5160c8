"""KML, read by GDAL and by an XML parser: every point where the scenario has it, with an honest altitude."""

from collections.abc import Callable
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
import shapely
from earth import local_m
from export_scene import ANGLES_DEG, ORIGIN
from pyogrio.raw import read

from nullpose import Result
from nullpose.errors import UsageError
from nullpose.report.export.kml import kml_file

Placed = Callable[..., Result]


def columns(content: bytes) -> tuple[dict[str, list[object]], np.ndarray]:
    """Returns what GDAL reads: the fields by name, and longitude, latitude and altitude of each point."""
    about, _, geometry, fields = read(content)
    return dict(zip(about["fields"], map(list, fields), strict=True)), shapely.get_coordinates(
        shapely.from_wkb(geometry), include_z=True
    )


@pytest.mark.parametrize(
    ("stated", "mode", "base_m"),
    [
        (("alt_m",), "relativeToGround", 0.0),  # over the ellipsoid, which KML does not know
        (("alt_msl_m",), "absolute", 185.0),
        (("alt_m", "alt_msl_m"), "absolute", 185.0),
    ],
)
def test_points_are_where_the_scenario_has_them(
    placed: Placed, stated: tuple[str, ...], mode: str, base_m: float
) -> None:
    """Longitude and latitude in this order; altitudes over the sea, or over the ground at the origin."""
    result = placed(*stated)
    fields, coordinates = columns(kml_file(result))
    scenario = result.scenario
    places_m = [result.pose.position_m, *scenario.node_positions_m, *scenario.jammer_positions_m]
    for (lon_deg, lat_deg, altitude_m), place_m in zip(coordinates, places_m, strict=True):
        found_m = local_m(lat_deg, lon_deg, altitude_m, (*ORIGIN[:2], base_m))
        np.testing.assert_allclose(found_m, place_m, rtol=0, atol=2e-3)
    assert set(fields["altitudeMode"]) == {mode}
    assert fields["Name"][1:] == [*scenario.node_names, *scenario.jammer_names]
    assert fields["kind"] == ["pose", "node", "node", "jammer"]
    angles = {name: float(fields[f"enu_{name}"][0]) for name in ANGLES_DEG}
    assert angles == pytest.approx(ANGLES_DEG)


def test_names_are_escaped(placed: Placed) -> None:
    """A name with marks of XML is the name that any reader finds."""
    result = placed("alt_m")
    jammer = result.scenario.jammers[0].model_copy(update={"name": '<van> & "co"'})
    scenario = result.scenario.model_copy(update={"jammers": (jammer,)})
    root = ElementTree.fromstring(kml_file(replace(result, scenario=scenario)))
    *_, name = root.findall(".//{*}name")
    assert name.text == '<van> & "co"'


def test_without_an_origin(placed: Placed) -> None:
    """A scenario that lies nowhere on the Earth is refused, with what to add."""
    result = placed("alt_m")
    nowhere = result.scenario.model_copy(update={"origin": None})
    with pytest.raises(UsageError, match=r"KML.*has no origin.*add a table headed \[origin\]"):
        kml_file(replace(result, scenario=nowhere))
