"""Shapefiles: their parts agree, or they are refused."""

from __future__ import annotations

from pathlib import Path

import pytest
import shapely
from geo_files import require_refusal, write_gdal, zones_of

ENDINGS = (".shp", ".shx", ".dbf")
SQUARES = [shapely.box(14.5 + east, 50.0, 14.501 + east, 50.001) for east in (0.0, 0.01, 0.02)]


def written(folder: Path, count: int) -> dict[str, bytes]:
    """Return the parts of a shapefile of squares, after writing them."""
    write_gdal(folder / "z.shp", [(square, {"name": f"{n}"}) for n, square in enumerate(SQUARES[:count])])
    return {ending: (folder / f"z{ending}").read_bytes() for ending in ENDINGS}


@pytest.mark.parametrize("ending", ENDINGS)
def test_a_part_of_another_number_of_records_is_refused(ending: str, tmp_path: Path) -> None:
    """Of more, of fewer, or none: GDAL would read what all of them have, and say nothing."""
    two, three = (written(tmp_path, count) for count in (2, 3))
    (tmp_path / f"z{ending}").write_bytes(two[ending])
    require_refusal(tmp_path, "z.shp", "its parts do not agree")
    written(tmp_path, 2)
    (tmp_path / f"z{ending}").write_bytes(three[ending])
    require_refusal(tmp_path, "z.shp", "its parts do not agree")
    (tmp_path / f"z{ending}").unlink()
    require_refusal(tmp_path, "z.shp", "needs its .shx and its .dbf" if ending != ".shp" else "z.shp")


@pytest.mark.parametrize("ending", ENDINGS)
@pytest.mark.parametrize("left", [0.3, 0.9, 0.99])
def test_a_part_that_is_cut_short_is_refused(ending: str, left: float, tmp_path: Path) -> None:
    """Wherever it ends."""
    whole = written(tmp_path, 3)[ending]
    (tmp_path / f"z{ending}").write_bytes(whole[: int(left * len(whole))])
    require_refusal(tmp_path, "z.shp", "do not agree|cannot be read")


def test_a_whole_one_is_read(tmp_path: Path) -> None:
    """Its endings may be in capitals."""
    written(tmp_path, 3)
    assert len(zones_of(tmp_path, "z.shp")[0].airspace.no_fly) == 3
    for ending in (*ENDINGS, ".prj"):
        (tmp_path / f"z{ending}").rename(tmp_path / f"z{ending.upper()}")
    assert len(zones_of(tmp_path, "z.SHP")[0].airspace.no_fly) == 3
