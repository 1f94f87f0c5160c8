"""A number at every point of a horizontal grid, as a map shows it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from nullpose.files import PlainTable, write_csv
from nullpose.notebook import imported
from nullpose.physics.types import FloatArray

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Field:
    """A number at every point of a horizontal grid.

    Args:
        east_m: (nx,) metres.
        north_m: (ny,) metres.
        altitude_m: of the plane, metres.
        values: (ny, nx), not a number where there is none.
        unit: as in "dB".
        title: what it shows.
        name: of the number, as in ``min_sinr_db``.
    """

    east_m: FloatArray
    north_m: FloatArray
    altitude_m: float
    values: FloatArray
    unit: str
    title: str
    name: str

    @property
    def best(self) -> tuple[float, tuple[float, float, float]]:
        """The largest value, and where it is, metres; not a number where no place is allowed."""
        row, column = np.unravel_index(np.argmax(np.nan_to_num(self.values, nan=-np.inf)), self.values.shape)
        place = (float(self.east_m[column]), float(self.north_m[row]), self.altitude_m)
        return float(self.values[row, column]), place

    def __repr__(self) -> str:
        value, (x, y, z) = self.best
        rows, columns = self.values.shape
        best = f"best {value:.7g} {self.unit} at ({x:z.3f}, {y:z.3f}, {z:z.3f}) m"
        return f"Field({self.name}: {columns} x {rows} places {self.altitude_m:g} m up; {best})"

    def to_xarray(self) -> xr.DataArray:
        """Return the map as an array of xarray over ``y_m`` and ``x_m``.

        Raises:
            UsageError: xarray is not installed.
        """
        places = {"y_m": self.north_m, "x_m": self.east_m, "z_m": self.altitude_m}
        return imported("xarray").DataArray(
            self.values, coords=places, dims=("y_m", "x_m"), name=self.name, attrs={"unit": self.unit}
        )

    def to_dict(self) -> PlainTable:
        """Return the map's plane and its best place as plain data; its numbers are in the CSV file."""
        value, position_m = self.best
        return {
            "name": self.name,
            "unit": self.unit,
            "altitude_m": self.altitude_m,
            "shape": list(self.values.shape),
            "best": {"value": value, "position_m": list(position_m)},
        }

    def write_csv(self, path: Path) -> Path:
        """Return the path of a CSV file after writing a line for each point; an empty cell is no value.

        Args:
            path: the file to write; an existing one is replaced.

        Raises:
            OutputError: the file cannot be written.
        """
        cells = (
            (east, north, self.altitude_m, value)
            for north, row in zip(self.north_m.tolist(), self.values.tolist(), strict=True)
            for east, value in zip(self.east_m.tolist(), row, strict=True)
        )
        lines = (["" if cell != cell else repr(cell) for cell in line] for line in cells)
        return write_csv(path, chain([["x_m", "y_m", "z_m", self.name]], lines))
