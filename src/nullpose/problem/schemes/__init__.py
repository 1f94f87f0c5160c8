"""The schemes, one file each: the paper's four cases.

Nothing heavy is imported here: the command line reads the names for its help.
"""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

from nullpose.errors import UsageError, require_usage
from nullpose.problem.schemes.maximum_gain import MAXIMUM_GAIN
from nullpose.problem.schemes.optimum import OPTIMUM
from nullpose.problem.schemes.record import SchemeRecord
from nullpose.problem.schemes.vertical import VERTICAL
from nullpose.problem.schemes.zero_interference import ZERO_INTERFERENCE

if TYPE_CHECKING:
    from nullpose.scenario import Scenario

__all__ = ["Scheme", "SchemeRecord", "as_scheme"]

RECORDS = {record.name: record for record in (OPTIMUM, ZERO_INTERFERENCE, MAXIMUM_GAIN, VERTICAL)}


class Scheme(StrEnum):
    """How the pose is chosen (paper section 4). A new scheme is a record in a file, and a line here."""

    OPTIMUM = OPTIMUM.name
    ZERO_INTERFERENCE = ZERO_INTERFERENCE.name
    MAXIMUM_GAIN = MAXIMUM_GAIN.name
    VERTICAL = VERTICAL.name

    @property
    def record(self) -> SchemeRecord:
        """The record of the scheme."""
        return RECORDS[self.value]

    @property
    def label(self) -> str:
        """The scheme's name for tables and figures."""
        return self.record.label

    def not_applicable(self, scenario: Scenario) -> str | None:
        """Say why the scheme has no meaning for a scenario; None if it has."""
        return self.record.not_applicable(scenario)

    def require_applicable(self, scenario: Scenario) -> None:
        """Raise a UsageError if the scheme has no meaning for a scenario."""
        reason = self.not_applicable(scenario)
        require_usage(reason is None, f"scheme {self.value}: {reason}; try another scheme")


def as_scheme(name: str) -> Scheme:
    """Find the scheme of a name.

    Args:
        name: as in ``maximum-gain``.

    Raises:
        UsageError: there is no such scheme.
    """
    try:
        return Scheme(name)
    except ValueError:
        from nullpose.scenario.faults import suggestion  # here, for it loads numpy

        raise UsageError(
            f"scheme: given {name!r}; allowed: {', '.join(Scheme)}{suggestion(name, list(Scheme))}"
        ) from None
