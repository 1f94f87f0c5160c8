"""The errors that nullpose raises: one root, few leaves, each with a message a person can act on."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from functools import partial, wraps
from inspect import Parameter, signature
from numbers import Integral, Real
from reprlib import repr as shortened
from types import NoneType, UnionType
from typing import Any, TypeVar, Union, cast, get_args, get_origin, get_type_hints

_MOST_TOLD = 20  # faults in a message
_NUMBERS = ("ArrayLike", "FloatArray")  # in the annotation of what becomes an array of numbers
_KINDS: dict[object, object] = {float: Real, int: Integral, None: NoneType}
_Called = TypeVar("_Called", bound=Callable[..., Any])


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


def require(kind: type[NullposeError], holds: object, message: str) -> None:
    """Raise an error of a kind unless a condition holds.

    Args:
        kind: of the error.
        holds: the condition.
        message: what was given, what is allowed and what to try.

    Raises:
        NullposeError: it does not hold.
    """
    if not holds:
        raise kind(message)


require_usage = partial(require, UsageError)
"""Raise a UsageError unless a condition holds, given with the message."""


def require_number(noun: str, number: int, least: int, most: int | None = None) -> int:
    """Return a whole number, as of a scene or of workers, unless it is out of range.

    Args:
        noun: in the message.
        number: to check.
        least: the smallest allowed.
        most: the largest allowed; None for any.

    Raises:
        UsageError: it is out of range, or no whole number.
    """
    allowed = f"a whole number of at least {least}" if most is None else f"{least} to {most}"
    is_whole = isinstance(number, int) and not isinstance(number, bool)
    fits = is_whole and least <= number <= (number if most is None else most)
    require_usage(fits, f"{noun}: given {number!r}; allowed: {allowed}")
    return number


def install_command(extra: str) -> str:
    """Write the command that installs what an extra needs, and where; no package index has nullpose.

    Args:
        extra: of ``pyproject.toml``, as in ``gis``.
    """
    return f"in a clone of nullpose run {sys.executable} -m pip install -e '.[{extra}]'"


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


class RequirementError(SolveError):
    """No pose was found that gives every node what it requires."""


def checked(called: _Called) -> _Called:
    """Have a function, or the making of a class, refuse arguments that it cannot use.

    They are looked at where a call fails, so this costs nothing elsewhere, and a failure whose arguments all
    fit stays what it is: a fault of the program.

    Args:
        called: with annotations of its parameters, which messages repeat.

    Example:
        >>> @checked
        ... def half(number: float) -> float:
        ...     return number / 2.0
        >>> half("three")
        Traceback (most recent call last):
        nullpose.errors.WrongTypeError: number: given 'three'; allowed: float
    """
    if isinstance(called, type):
        setattr(called, "__init__", checked(vars(called)["__init__"]))  # noqa: B010  mypy knows no other
        return called

    @wraps(called)
    def call(*args: Any, **options: Any) -> Any:
        try:
            return called(*args, **options)
        except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
            if not isinstance(error, NullposeError):
                _refuse_arguments(called, args, options)
            raise

    return cast(_Called, call)


def _refuse_arguments(
    called: Callable[..., Any], args: Sequence[object], options: Mapping[str, object]
) -> None:
    """Raise the fault of arguments that do not fit, if there is any."""
    parameters, names = signature(called).parameters, vars(sys.modules[called.__module__])
    allowed = {name: each.annotation for name, each in parameters.items() if name not in ("self", "cls")}
    for name, parameter in parameters.items():
        if parameter.kind is Parameter.VAR_KEYWORD:  # those of a typed dictionary, or any
            more = get_args(_hint(allowed.pop(name), names))
            allowed |= get_type_hints(more[0]) if more else dict.fromkeys(options, "")
    for name in [name for name in options if name not in allowed]:
        guess = get_close_matches(name, allowed, 1)
        meant = f"; did you mean {guess[0]}?" if guess else ";"
        raise UsageError(f"{name}: unknown option{meant} allowed: {', '.join(allowed)}") from None
    try:
        signature(called).bind(*args, **options)
    except TypeError as error:
        raise UsageError(f"{called.__qualname__}: {error}; allowed: {', '.join(allowed)}") from None
    first = len(parameters.keys() & {"self", "cls"})
    for name, value in {**dict(zip(allowed, args[first:], strict=False)), **options}.items():
        if not _fits(value, _hint(allowed[name], names), str(allowed[name])):
            words = getattr(allowed[name], "__name__", allowed[name])
            path = isinstance(value, str | os.PathLike) and words == "Scenario"
            tried = f"; try Scenario.from_file({value!r})" if path else ""
            raise WrongTypeError(f"{name}: given {shortened(value)}; allowed: {words}{tried}") from None


def _hint(annotation: Any, names: dict[str, Any]) -> Any:
    """Return the type that an annotation states; Any for one that only a type checker knows."""
    try:
        return eval(annotation, names) if isinstance(annotation, str) and annotation else annotation
    except NameError:
        return Any


def _fits(value: object, hint: Any, words: str = "") -> bool:
    """Tell whether a value is of a type; of what is not known here it is taken to be."""
    kind, parts = get_origin(hint), get_args(hint)
    if any(word in words for word in _NUMBERS):
        from numpy import asarray

        try:
            return asarray(value, dtype=float) is not None
        except (TypeError, ValueError):
            return False
    if kind in (Union, UnionType):
        return any(_fits(value, part) for part in parts)
    if isinstance(kind, type):  # with members
        members: Any = value if hasattr(value, "__len__") else ()
        is_kind = isinstance(value, kind) and not isinstance(value, str)
        return is_kind and all(_fits(each, parts[0]) for each in members)
    return not isinstance(hint := _KINDS.get(hint, hint), type) or isinstance(value, hint)
