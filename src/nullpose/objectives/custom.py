"""An objective of one's own in Python: any number that rises with every node's SINR at the drone."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike

from nullpose.objectives.min_sinr import MIN_SINR
from nullpose.objectives.ratios import FloatArray
from nullpose.objectives.record import ObjectiveRecord, Quantity

_SAMPLES = 200  # SINRs at which the function is tried
_ROUNDING = 1e-9


@dataclass(frozen=True)
class Custom:
    """An objective that is a function in Python, to be maximised.

    It stands in a scenario for the name of an objective: ``Scenario.from_arrays(..., objective=Custom(f))``.
    Poses are searched, and there is no bound. A file cannot hold it.

    Args:
        function: from the nodes' SINRs at the drone (linear ratios, an array of shape (n_nodes,), in the
            order of the nodes) to a number that does not fall if one of them rises. Minus infinity is a pose
            that is not wanted. The scenario refuses another function, from samples.
        name: for outputs.

    Example:
        >>> import numpy as np
        >>> import nullpose
        >>> rest = nullpose.objective.Custom(lambda sinr: np.sort(sinr)[1], name="second smallest SINR")
        >>> scenario = nullpose.Scenario.from_arrays(
        ...     [[0, 0, 0], [0, 50, 0], [40, 20, 0], [300, 0, 0]],
        ...     [[17, 15, 4]],
        ...     noise_w=1e-3,
        ...     altitude_m=(8, 30),
        ...     objective=rest,
        ... )
        >>> result = nullpose.solve(scenario)
        >>> round(result.objective.value, 3), str(result.status), result.objective.upper_bound
        (0.771, 'best-found', None)
    """

    function: Callable[[FloatArray], float]
    name: str = "custom"

    def __str__(self) -> str:
        return self.name

    @property
    def record(self) -> ObjectiveRecord:
        """What the objective states of itself."""
        quantity = Quantity("custom", "SINR", self.name, "SINR", "units", "SINR", "sinr", whole=self.name)
        return replace(
            MIN_SINR,
            name=self.name,
            quantities=(quantity,),
            quantity=lambda scenario: quantity,
            evaluate=lambda reception: {"sinr": reception.sinr},
            of_nodes=self.values_of,
            unused=(*MIN_SINR.unused, "nodes.min_sinr_db", "nodes.weight"),
        )

    def values_of(self, sinr: ArrayLike) -> FloatArray:
        """Evaluate the function, (...), from the SINR of every node, (..., n_nodes); NaN for no number."""
        rows = np.asarray(sinr, dtype=float)
        returned = [self.function(row.copy()) for row in rows.reshape(-1, rows.shape[-1])]
        numbers = [value if isinstance(value, Real) and value < math.inf else math.nan for value in returned]
        return np.array(numbers, dtype=float).reshape(rows.shape[:-1])

    def fault(self, n_nodes: int) -> str:
        """Try the function on samples, and say what is wrong with it; empty if nothing is.

        Args:
            n_nodes: how many SINRs it is given.
        """
        rng, node = np.random.default_rng(0), np.arange(_SAMPLES) % n_nodes
        low = 10.0 ** rng.uniform(-4.0, 4.0, (_SAMPLES, n_nodes))
        high = low * np.where(node[:, None] == np.arange(n_nodes), rng.uniform(1.0, 10.0, (_SAMPLES, 1)), 1.0)
        sinr = np.stack([low, high])
        values = self.values_of(sinr)
        for each in sinr[~np.isfinite(values)]:
            return (
                f"got {self.name}, which returns {self.function(each)!r} for the SINRs {each}; must return a "
                "finite number, as float(np.min(sinr))"
            )
        for at in np.flatnonzero(values[1] < values[0] - _ROUNDING * np.abs(values[0])):
            (from_value, to_value), (from_sinr, to_sinr) = values[:, at], sinr[:, at, node[at]]
            return (
                f"got {self.name}, which falls from {from_value:.6g} to {to_value:.6g} where the SINR of "
                f"node {node[at] + 1} rises from {from_sinr:.6g} to {to_sinr:.6g}; must fall with no SINR"
            )
        return ""
