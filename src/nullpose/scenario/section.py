"""The base of every table in a scenario file: frozen, closed, and reporting all its faults together."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Self, get_args

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator
from pydantic.fields import FieldInfo
from pydantic.functional_validators import ModelWrapValidatorHandler

from nullpose.scenario.faults import Place, as_error_details, collected, rejection, scenario_error
from nullpose.scenario.rewording import table_faults
from nullpose.scenario.wording import described

__all__ = ["MOST_MEMBERS", "Section", "inner_section"]

MOST_MEMBERS = 10_000
"""The most members of a list, such as nodes or the corners of a polygon."""

_MOST_UNKNOWN = 20  # keys of a table that are judged one by one


class Section(BaseModel):
    """A frozen table with named keys; building a faulty one raises ScenarioError with every fault."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    header: ClassVar[str] = ""
    """What the table is called and how it is headed in a file."""
    letter: ClassVar[str | None] = None
    """The letter of names given by place, as the S of S1, S2, ...; None for a table alone of its kind."""
    pairs: ClassVar[tuple[tuple[str, str], ...]] = ()
    """Keys of which exactly one is given, each pair being one quantity in two units."""
    alternatives: ClassVar[tuple[tuple[str, str], ...]] = ()
    """Keys of which at most one is given."""
    shapes: ClassVar[tuple[tuple[str, ...], ...]] = ()
    """Groups of keys of which exactly one is given, and given whole."""
    ways: ClassVar[tuple[tuple[str, ...], ...]] = ()
    """Groups of keys that state one required thing; one group is given whole."""
    unstated: ClassVar[frozenset[str]] = frozenset()
    """Keys that ``to_dict`` leaves out while they have their default."""

    def __init__(self, /, **data: Any) -> None:
        try:
            super().__init__(**data)
        except ValidationError as error:
            raise scenario_error(error, data) from None

    # Tables inside tables must be built by pydantic's own path: it merges their faults with the rest,
    # where a call of this constructor would fold them into one. This is pydantic's mark for that.
    __init__.__dict__["__pydantic_base_init__"] = True

    @classmethod
    def from_dict(cls, data: object, source: str = "") -> Self:
        """Returns the table that plain values describe, as ``to_dict`` writes them.

        Args:
            data: a mapping with the keys of a scenario file.
            source: the file or object at fault in messages, as the user would name it.

        Raises:
            ScenarioError: with every fault of the data.
        """
        try:
            return cls.model_validate(data)
        except ValidationError as error:
            raise scenario_error(error, data, source) from None

    def to_dict(self) -> dict[str, Any]:
        """Returns plain numbers, texts, lists and tables, ready for JSON; keys left out stay out."""
        values = {key: getattr(self, key) for key in type(self).model_fields}
        return {key: _plain(value) for key, value in values.items() if not self._is_left_out(key, value)}

    def _is_left_out(self, key: str, value: object) -> bool:
        default = type(self).model_fields[key].default
        return value is None or (key in self.unstated and bool(value == default))

    @classmethod
    def completed(cls, data: Mapping[str, object]) -> Mapping[str, object]:
        """Returns the raw table with what follows from its own values filled in."""
        return data

    @classmethod
    def cross_faults(cls, data: Mapping[str, object]) -> Iterable[tuple[Place, str]]:
        """Returns the faults between several values of the raw table, as far as they can be judged."""
        return ()

    @model_validator(mode="wrap")
    @classmethod
    def _report_together(cls, data: object, handler: ModelWrapValidatorHandler[Self]) -> Self:
        if isinstance(data, cls):
            return data
        if not isinstance(data, Mapping):
            raise rejection(f"got {described(data)}, must be {cls.header}")
        for key, value in data.items():
            if isinstance(value, list | tuple) and len(value) > MOST_MEMBERS:
                message = f"there are more than {MOST_MEMBERS} members, the most that are allowed"
                raise collected(cls.__name__, [as_error_details((key,), message)])
        table, error = None, None
        known = cls.model_fields
        untold = set([key for key in data if key not in known][_MOST_UNKNOWN:])
        if untold:
            data = {key: value for key, value in data.items() if key not in untold}
        try:
            table = handler(cls.completed(data))
        except ValidationError as several:
            error = several
        details = table_faults(error, data, known, cls.pairs, cls.alternatives, cls.ways)
        if untold:
            details.append(as_error_details((), f"{len(untold)} more keys are unknown; remove them too"))
        details += [as_error_details(place, message) for place, message in cls.cross_faults(data)]
        if table is None or details:
            raise collected(cls.__name__, details)
        return table

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Returns a copy with some values replaced, validated like any other.

        Args:
            update: new values by key.
            deep: without meaning here, since everything inside is frozen.

        Raises:
            ScenarioError: when the copy would be faulty.
        """
        values = {key: getattr(self, key) for key in type(self).model_fields}
        return type(self)(**values | dict(update or {}))

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: dict[int, Any] | None = None) -> Self:
        return self

    def __getstate__(self) -> dict[Any, Any]:
        # Cached arrays stay behind: they would come back writeable.
        state = super().__getstate__()
        fields = type(self).model_fields
        return state | {"__dict__": {key: value for key, value in state["__dict__"].items() if key in fields}}

    def _values(self) -> tuple[object, ...]:
        return tuple(getattr(self, key) for key in type(self).model_fields)

    def __eq__(self, other: object) -> bool:
        # Not pydantic's own comparison, which would meet the cached arrays too.
        if not isinstance(other, Section):
            return NotImplemented
        return type(self) is type(other) and self._values() == other._values()

    def __hash__(self) -> int:
        return hash((type(self), self._values()))

    if not TYPE_CHECKING:  # type checkers know from the configuration that fields are frozen

        def __setattr__(self, name: str, value: object) -> None:
            raise AttributeError(f"cannot set {name}: scenarios are frozen; see model_copy for a changed one")

        def __delattr__(self, name: str) -> None:
            raise AttributeError(f"cannot delete {name}: scenarios are frozen")


def inner_section(field: FieldInfo, kind: type[Section] = Section) -> type[Section] | None:
    """Returns the kind of table that a field holds, or a list of; None if it holds no table of a kind.

    Args:
        field: a field of a table.
        kind: the kind looked for, with those made from it.
    """
    pending = [field.annotation]
    while pending:
        annotation = pending.pop()
        if isinstance(annotation, type) and issubclass(annotation, kind):
            return annotation
        pending += get_args(annotation)
    return None


def _plain(value: object) -> object:
    if isinstance(value, Section):
        return value.to_dict()
    return [_plain(member) for member in value] if isinstance(value, tuple) else value
