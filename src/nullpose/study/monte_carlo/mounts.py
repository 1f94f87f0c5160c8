"""The best mount of a case: one for all scenes of a study, since a vehicle is built once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from nullpose.study.case import Case
from nullpose.study.monte_carlo.chunk import rows_of
from nullpose.study.monte_carlo.draw import quantity_of
from nullpose.study.monte_carlo.spec import StudySpec

_STAGES = ((15.0, 3), (5.0, 2), (1.0, 2))  # degrees between two mounts, and how many to each side


def with_best_mounts(spec: StudySpec, on_note: Callable[[str], None]) -> StudySpec:
    """Return a study with a number for every mount that its scenes choose, to a degree.

    A mount's level is the median over the first scenes, searched without proofs, in dB (or bits/s/Hz),
    averaged over the combinations of swept values. Mounts 15 degrees apart are tried from 0 to 90 degrees,
    then mounts 5 degrees and 1 degree apart beside the best. A higher level between mounts that are not tried
    may be missed.

    Args:
        spec: the study.
        on_note: called with a sentence before mounts are tried.
    """
    cases = [_with_best_mount(spec, case, on_note) if case.mount_scenes else case for case in spec.cases]
    return spec.model_copy(update={"cases": cases})


def _with_best_mount(spec: StudySpec, case: Case, on_note: Callable[[str], None]) -> Case:
    best_deg, levels = 45.0, dict[float, float]()
    scenes, quantity = min(case.mount_scenes or 1, spec.n_scenes), quantity_of(spec)
    search = {"certify": None if case.pose else False}  # proofs would take three times as long
    for step_deg, count in _STAGES:
        on_note(f"case {case.name}: mounts in steps of {step_deg:g} degrees are tried")
        mounted = {
            mount: case.mounted(mount, name=str(mount), **search)
            for mount in (best_deg + step_deg * step for step in range(-count, count + 1))
            if 0 <= mount <= 90
        }
        rows = rows_of(spec.model_copy(update={"cases": list(mounted.values())}), 0, scenes - 1)
        values = [quantity.in_unit(row.get("value", 0.0)) for row in rows]  # no pose is no signal
        medians = np.median(np.reshape(values, (scenes, -1, len(mounted))), axis=0)  # by point and mount
        levels |= dict(zip(mounted, medians.mean(axis=0).tolist(), strict=True))
        best_deg = max(levels, key=levels.__getitem__)
    return case.mounted(best_deg)
