"""How much work a solve may do: the search, and the proof or none."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from nullpose.solve.limits import Limits
from nullpose.solve.multistart import SearchSettings

__all__ = ["Effort"]

_THOROUGH = SearchSettings()
_LIGHT = SearchSettings(coarse=16, polished=2, rounds=2, patience=1)


@dataclass(frozen=True, slots=True, kw_only=True)
class Effort:
    """What a scheme may spend.

    Args:
        seed: seed of the multistart.
        limits: the proof's target and what it may cost; None leaves the proof out.
        on_progress: called now and then during a proof with the gap proved so far and the nodes examined.
    """

    seed: int = 0
    limits: Limits | None = None
    on_progress: Callable[[float, int], None] | None = None

    @property
    def search(self) -> SearchSettings:
        """How hard the multistart tries: lightly if a proof follows, which repairs what it misses."""
        return _THOROUGH if self.limits is None else _LIGHT
