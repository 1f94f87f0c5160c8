"""The values of a study, read part by part into arrays that stay small."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nullpose.physics import to_db
from nullpose.physics.types import FloatArray
from nullpose.study.monte_carlo import StudyTable

if TYPE_CHECKING:
    import pandas as pd

# A status is kept as its place here.
STATUSES = ("certified", "gap-not-reached", "best-found", "given", "failed")
FAILED = STATUSES.index("failed")

_KINDS = {
    "value": np.float64,
    "bound": np.float64,
    "gap": np.float32,
    "status": np.uint8,
    "seconds": np.float32,
    "null_gain": np.float32,
}
_MOST_REASONS = 10_000  # reasons may quote numbers, so that each row has its own


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyValues:
    """What the rows of a study say, by scene, combination of swept values, and case: 29 bytes for each.

    Args:
        value: what the pose reaches, in dB or bits/s/Hz, shape ``(n, p, c)``; NaN of a failure.
        bound: no pose exceeds it, likewise; NaN if nothing is proved.
        gap: relative gap; NaN if nothing is proved.
        status: places in ``STATUSES``.
        seconds: how long each took; NaN of a failure.
        null_gain: smallest gain towards a jammer or an eavesdropper, over its largest; NaN without one.
        reasons: how often each case failed, or kept from its gap, for which reason, by case, status, reason.
    """

    value: FloatArray
    bound: FloatArray
    gap: NDArray[np.float32]
    status: NDArray[np.uint8]
    seconds: NDArray[np.float32]
    null_gain: NDArray[np.float32]
    reasons: Counter[tuple[str, str, str]]

    @property
    def scenes(self) -> int:
        """How many scenes there are rows of."""
        return int(self.value.shape[0])

    def at(self, point: int) -> StudyValues:
        """Return what is said at one combination of swept values, by scene and case: all of shape ``(n, c)``.

        Args:
            point: the combination's number.
        """
        return replace(self, **{name: getattr(self, name)[:, point] for name in _KINDS})

    def counts(self) -> dict[str, int]:
        """Return how many rows have each status."""
        return {name: int(np.sum(self.status == code)) for code, name in enumerate(STATUSES)}


def gather(table: StudyTable, on_batch: Callable[[pd.DataFrame], object] | None = None) -> StudyValues:
    """Return the values of all rows that are done, reading them once, part by part.

    Args:
        table: the study's rows.
        on_batch: given each part's rows, with what is maximised in dB beside it if it is a ratio.

    Raises:
        UsageError: a part is damaged.
    """
    spec, quantity = table.spec, table.quantity
    inner = (len(spec.points), len(spec.cases))
    shape = (table.scenes_done, *inner)
    arrays = {name: np.zeros(shape, kind) for name, kind in _KINDS.items()}
    reasons: Counter[tuple[str, str, str]] = Counter()
    done = 0
    for batch in table.batches():
        end = done + len(batch) // spec.rows_per_scene
        columns = batch.assign(
            status=batch["status"].map(STATUSES.index),
            seconds=batch["seconds"].mask(batch["status"] == STATUSES[FAILED]),
        )
        if not quantity.is_rate:
            place = batch.columns.get_loc("gap")
            for name in ("bound", "value"):
                columns[name] = to_db(batch[name].to_numpy(float, na_value=np.nan))
                batch.insert(place, f"{name}_db", columns[name])
        for name, kind in _KINDS.items():
            arrays[name][done:end] = columns[name].to_numpy(kind).reshape(-1, *inner)
        _count_reasons(reasons, batch)
        if on_batch is not None:
            on_batch(batch)
        done = end
    return StudyValues(**arrays, reasons=reasons)


def _count_reasons(reasons: Counter[tuple[str, str, str]], batch: pd.DataFrame) -> None:
    told = batch.loc[batch["reason"] != "", ["case", "status", "reason"]]
    for (case, status, reason), count in told.astype(str).value_counts(sort=False).items():
        known = (case, status, reason) in reasons or len(reasons) < _MOST_REASONS
        reasons[case, status, reason if known else "other reasons"] += int(count)
