"""The errors that nullpose raises: one root, few leaves, each with a message a person can act on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

_MOST_TOLD = 20  # faults in a message


class NullposeError(Exception):
    """Root of everything that nullpose raises on purpose."""


@dataclass(frozen=True, slots=True)
class Fault:
    """One thing wrong with an input, and where.

    Args:
        path: place in the input, as in ``jammers[1].power_w``; empty for the input as a whole.
        message: what was given, what is allowed and what to try.
    """

    path: str
    message: str

    def __str__(self) -> str:
        return f"{self.path}: {self.message}" if self.path else self.message


class ScenarioError(NullposeError, ValueError):
    """A scenario that cannot be used; it lists every fault, not only the first, and tells the first 20.

    Args:
        faults: everything that is wrong, in the order of the input.
        source: the file or object at fault, as the user would name it; empty if there is none.
    """

    def __init__(self, faults: Sequence[Fault], source: str = "") -> None:
        self.faults = tuple(faults)
        self.source = source
        lines = [str(fault) for fault in self.faults[:_MOST_TOLD]]
        if len(self.faults) > len(lines):
            lines.append(f"... and {len(self.faults) - len(lines)} more")
        if source:
            count = "1 fault" if len(self.faults) == 1 else f"{len(self.faults)} faults"
            lines = [f"{source}: {count}", *(f"  {line}" for line in lines)]
        super().__init__("\n".join(lines))

    def __reduce__(self) -> tuple[type[ScenarioError], tuple[tuple[Fault, ...], str]]:
        return type(self), (self.faults, self.source)


class UsageError(NullposeError, ValueError):
    """A request that does not fit its scenario or its options, such as a null without a jammer."""


def require_usage(holds: object, message: str) -> None:
    """Raise a UsageError unless a condition holds.

    Args:
        holds: the condition.
        message: what was given, what is allowed and what to try.

    Raises:
        UsageError: it does not hold.
    """
    if not holds:
        raise UsageError(message)


class WrongTypeError(UsageError, TypeError):
    """A value of a type that does not belong there, such as a path where a scenario is asked for."""


class CertificateError(NullposeError, ValueError):
    """A file that is no certificate, or one made for another scenario than the one inside."""


class ClusterError(NullposeError, RuntimeError):
    """A cluster that is not there, went away, or whose workers cannot do the work."""


class OutputError(NullposeError, OSError):
    """A result that could not be written where it was asked for."""


class SolveError(NullposeError, RuntimeError):
    """A solve that ended without a pose that can be reported."""
