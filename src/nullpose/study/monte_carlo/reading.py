"""A study's rows, as tables to work with."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nullpose.errors import UsageError
from nullpose.study.monte_carlo.extra import require_extra
from nullpose.study.monte_carlo.rows import schema_of
from nullpose.study.monte_carlo.spec import StudySpec
from nullpose.study.monte_carlo.store import Part, Store

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa
    import xarray as xr

__all__ = ["StudyTable", "read_study"]


class StudyTable:
    """The rows of a study that are done, by scene, combination of swept values and case.

    Args:
        store: the study's folder.
    """

    def __init__(self, store: Store) -> None:
        self._store = store
        self.manifest: dict[str, Any] = store.manifest()
        """What made the study: spec, its hash, versions, seed, objective."""
        self.spec = StudySpec.from_dict(self.manifest["spec"], str(store.folder))
        """The study's spec."""
        self._parts = sorted(store.listed().values(), key=lambda part: part.first)

    @property
    def scenes_done(self) -> int:
        """How many scenes there are rows of."""
        return sum(part.last - part.first + 1 for part in self._parts)

    @property
    def is_complete(self) -> bool:
        """Whether there are rows of every scene."""
        return self.scenes_done == self.spec.n_scenes

    def frame(self) -> pd.DataFrame:
        """Return all rows as a data frame; the case is a category, in the spec's order.

        Raises:
            UsageError: a part is damaged.
        """
        import pyarrow as pa

        tables = [self._table(part) for part in self._parts]
        whole = pa.concat_tables(tables) if tables else schema_of(self.spec).empty_table()
        return self._as_frame(whole)

    def batches(self) -> Iterator[pd.DataFrame]:
        """Yield the rows part by part, each as :meth:`frame` would have them, never holding all.

        Raises:
            UsageError: a part is damaged.
        """
        for part in self._parts:
            yield self._as_frame(self._table(part))

    def xarray(self) -> xr.Dataset:
        """Return all rows as arrays over scene, each swept parameter, and case.

        Raises:
            UsageError: a part is damaged.
        """
        import xarray as xr

        frame, spec = self.frame(), self.spec
        scenes = frame["scene"].to_numpy()[:: spec.rows_per_scene]
        shape = (len(scenes), *(len(values) for _, values in spec.sweep), len(spec.cases))
        dims = ("scene", *spec.swept, "case")
        left_out = {"scene", "point", "case", *spec.swept}
        columns = [str(name) for name in frame.columns if name not in left_out]
        coordinates = {"scene": scenes, "case": list(spec.case_names)}
        coordinates |= {path: list(values) for path, values in spec.sweep}
        return xr.Dataset(
            {name: (dims, frame[name].to_numpy().reshape(shape)) for name in columns},
            coords=coordinates,
            attrs={"name": spec.name, "objective": self.manifest["objective"]},
        )

    def _table(self, part: Part) -> pa.Table:
        import pyarrow.parquet as pq

        if not self._store.is_whole(part):
            raise UsageError(
                f"{self._store.parts_folder / part.name}: damaged or missing (its checksum is not the one "
                "listed); nullpose study run, given the same spec and folder, does it anew"
            )
        path = self._store.parts_folder / part.name
        try:
            table = pq.read_table(path, partitioning=None)
        except (OSError, ValueError) as error:
            raise UsageError(
                f"{path}: cannot be read ({error}); remove it, and run the study again"
            ) from None
        if not table.schema.equals(schema_of(self.spec)):
            raise UsageError(f"{path}: has other columns than this study; remove it, and run the study again")
        return table

    def _as_frame(self, table: pa.Table) -> pd.DataFrame:
        frame = table.to_pandas()
        frame["case"] = frame["case"].astype("category").cat.set_categories(list(self.spec.case_names))
        return frame


def read_study(out: str | os.PathLike[str]) -> StudyTable:
    """Return the rows of the study in a folder, as far as it is; whole parts alone are read.

    Args:
        out: the folder.

    Raises:
        UsageError: no study is there, or an extra is missing.
    """
    require_extra()
    return StudyTable(Store(Path(out)))
