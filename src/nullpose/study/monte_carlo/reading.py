"""What is in a study's folder: how far it is, and its rows as tables to work with."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from nullpose.errors import UsageError
from nullpose.files import PlainTable
from nullpose.solver import Rigour
from nullpose.study.monte_carlo.folder import QUANTITIES, Folder, PartFile, require_extra
from nullpose.study.monte_carlo.rows import read_counts, read_parquet, schema_of
from nullpose.study.monte_carlo.spec import StudySpec

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa
    import xarray as xr

_SHOWN = 10  # rows of a large table


class StudyTable:
    """The rows of a study that are done, by scene, combination of swept values and case.

    Args:
        folder: of the study.
    """

    def __init__(self, folder: Folder) -> None:
        self._parts = folder.parts()
        self.manifest: PlainTable = folder.manifest()
        """What made the study: spec, its hash, versions, seed, objective."""
        self.spec = StudySpec.from_dict(self.manifest["spec"], str(folder.path))
        """The study's spec."""
        self.quantity = QUANTITIES[self.manifest["objective"]]
        """The maximised quantity."""

    @property
    def scenes_done(self) -> int:
        """How many scenes there are rows of."""
        return sum(part.scenes for part in self._parts)

    @property
    def is_complete(self) -> bool:
        """Whether there are rows of every scene."""
        return self.scenes_done == self.spec.n_scenes

    def frame(self) -> pd.DataFrame:
        """Return all rows as a data frame; the case is a category, in the spec's order.

        Raises:
            UsageError: a part is damaged.
        """
        import pandas as pd

        return pd.concat(self.batches(), ignore_index=True)

    def batches(self) -> Iterator[pd.DataFrame]:
        """Yield the rows part by part, each as :meth:`frame` has them, never holding all.

        Raises:
            UsageError: a part is damaged.
        """
        for part in self._parts:
            try:
                yield self._as_frame(read_parquet(self.spec, part.path))
            except ValueError as error:
                again = "nullpose study run, given the same spec and folder, does it anew"
                raise UsageError(f"{part.path}: damaged ({error}); {again}") from None
        if not self._parts:
            yield self._as_frame(schema_of(self.spec).empty_table())

    def __repr__(self) -> str:
        done, name = self.scenes_done, self.spec.name
        return f"StudyTable({name!r}: {done} of {self.spec.n_scenes} scenes, {self.quantity.smallest})"

    def _repr_html_(self) -> str:
        return str(next(self.batches()).head(_SHOWN).to_html(index=False))

    def to_xarray(self) -> xr.Dataset:
        """Return all rows as arrays over scene, each swept parameter, and case.

        Raises:
            UsageError: a part is damaged.
        """
        spec = self.spec
        frame = self.frame().drop(columns="point").astype({"case": object})
        return (
            frame.set_index(["scene", *spec.swept, "case"])
            .to_xarray()
            .reindex({**{path: list(values) for path, values in spec.sweep}, "case": list(spec.case_names)})
            .assign_attrs(name=spec.name, objective=self.manifest["objective"])
        )

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
    return StudyTable(Folder(Path(out)))


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyStatus:
    """How far a study is.

    Args:
        folder: where it is.
        name: its title.
        scenes: how many it has.
        done: how many of them are in parts.
        rows: rows of these.
        failed: how many of those are failures.
        parts: how many parts there are.
        chunk: scenes of a part.
        size: bytes of all parts.
        worked_s: seconds that workers spent on the parts.
        running: who writes the folder now; empty if nobody does.
    """

    folder: str
    name: str
    scenes: int
    done: int
    rows: int
    failed: int
    parts: int
    chunk: int
    size: int
    worked_s: float
    running: str

    @property
    def complete(self) -> bool:
        """Whether all scenes are done."""
        return self.done == self.scenes

    def to_dict(self) -> PlainTable:
        """Return the status as plain data."""
        return asdict(self) | {"complete": self.complete, "rigour": Rigour.FLOATING_POINT.value}


def study_status(out: str | os.PathLike[str]) -> StudyStatus:
    """Count the scenes and rows of the study in a folder.

    Args:
        out: the folder.

    Raises:
        UsageError: no study is there.
    """
    folder = Folder(Path(out))
    manifest, done = folder.manifest(), dict[PartFile, tuple[int, int, float]]()
    for part in folder.parts():
        with suppress(ValueError):  # a damaged part is done anew by the next run
            done[part] = read_counts(part.path)
    return StudyStatus(
        folder=str(out),
        name=manifest["name"],
        scenes=manifest["scenes"],
        done=sum(part.scenes for part in done),
        rows=sum(rows for rows, _, _ in done.values()),
        failed=sum(failed for _, failed, _ in done.values()),
        parts=len(done),
        chunk=manifest["chunk"],
        size=sum(part.path.stat().st_size for part in done),
        worked_s=sum(seconds for _, _, seconds in done.values()),
        running=folder.owner,
    )


def study_spec(out: str | os.PathLike[str]) -> StudySpec:
    """Return the spec of the study in a folder.

    Args:
        out: the folder.

    Raises:
        UsageError: no study is there.
    """
    return StudySpec.from_dict(Folder(Path(out)).manifest()["spec"], str(out))
