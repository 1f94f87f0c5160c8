"""The base of every table in a scenario file: frozen, closed, and reporting all its faults together."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from functools import cache
from itertools import chain
from typing import Any, ClassVar, Self, TypeAlias, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    SerializerFunctionWrapHandler,
    TypeAdapter,
    ValidationError,
    model_serializer,
    model_validator,
)
from pydantic.functional_validators import ModelWrapValidatorHandler

from nullpose.errors import WrongTypeError
from nullpose.files import PlainTable
from nullpose.scenario.faults import (
    Place,
    collected,
    described,
    nearest,
    rejection,
    reworded,
    scenario_error,
    unknown,
)
from nullpose.scenario.rules import MOST_MEMBERS
from nullpose.scenario.ways import Ways

Floats: TypeAlias = NDArray[np.float64]
_MOST_UNKNOWN = 20  # keys of a table that are judged one by one


class Section(BaseModel):
    """A frozen table with named keys; building a faulty one raises ScenarioError with every fault.

    What a kind of table states of itself stands in the line of its class:
    ``class Jammer(GroundPoint, letter="M")``.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    header: ClassVar[str] = ""
    """What the table is called and how it is headed in a file; empty where it is headed by its own name."""
    letter: ClassVar[str | None] = None
    """The letter of names given by place, as the S of S1, S2, ...; None for a table alone of its kind."""
    ways: ClassVar[tuple[Ways, ...]] = ()
    """Keys that belong together."""
    unstated: ClassVar[frozenset[str]] = frozenset()
    """Keys that ``to_dict`` leaves out while they have their default."""

    def __init_subclass__(
        cls,
        *,
        header: str | None = None,
        letter: str | None = None,
        ways: Iterable[Ways] = (),
        unstated: Iterable[str] = (),
    ) -> None:
        """State a kind of table; it has the ways and the unstated keys of its bases too.

        Args:
            header: as the attribute, unless that stands in the class; likewise
            letter: and
            ways: of which one takes the place of a base's with the same keys, and
            unstated: names of keys.
        """
        super().__init_subclass__()
        own, bases = vars(cls), [base for base in reversed(cls.__bases__) if issubclass(base, Section)]
        cls.header, cls.letter = header or cls.header, letter or cls.letter
        listed = chain(*(base.ways for base in bases), own.get("ways", ways))
        cls.ways = tuple({each.groups: each for each in listed}.values())
        cls.unstated = cls.unstated.union(unstated, *(base.unstated for base in bases))

    def __init__(self, /, *nameless: object, **data: object) -> None:
        if nameless:
            name = type(self).__name__
            raise WrongTypeError(f"{name}: given a value without its key; allowed: keys, or {name}.from_dict")
        try:
            super().__init__(**data)
        except ValidationError as error:
            raise scenario_error(error, data) from None

    # Tables inside tables must be built by pydantic's own path: it merges their faults with the rest,
    # where a call of this constructor would fold them into one. This is pydantic's mark for that.
    __init__.__dict__["__pydantic_base_init__"] = True

    @classmethod
    def from_dict(cls, data: object, source: str = "") -> Self:
        """Return the table that plain values describe, as ``to_dict`` writes them.

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

    def to_dict(self) -> PlainTable:
        """Return plain numbers, texts, lists and tables, ready for JSON; keys left out stay out."""
        return self.model_dump(mode="json")

    @model_serializer(mode="wrap")
    def _serialised(self, handler: SerializerFunctionWrapHandler) -> PlainTable:
        fields = type(self).model_fields
        left_out = {key for key in self.unstated if getattr(self, key) == fields[key].default}
        return {
            key: value for key, value in handler(self).items() if value is not None and key not in left_out
        }

    @classmethod
    def heading(cls) -> str:
        """Name the table and its heading in a file."""
        return cls.header or f"a table headed [{cls.__name__.lower()}]"

    @classmethod
    def completed(cls, data: Mapping[str, object]) -> Mapping[str, object]:
        """Fill in the keys of a raw table that follow from its own values."""
        return data

    def faults(self, raw: PlainTable) -> Iterable[tuple[Place, str]]:
        """List the faults between several values of a table; those with a fault of their own are None.

        Args:
            raw: the raw table, as it was before anything was filled in.
        """
        return ()

    @model_validator(mode="wrap")
    @classmethod
    def _judged(cls, data: object, handler: ModelWrapValidatorHandler[Self]) -> Self:
        """Judge keys, values, and keys and values together; raise all that is wrong."""
        if isinstance(data, cls):
            return data
        if not isinstance(data, Mapping):
            raise rejection(f"got {described(data)}, must be {cls.heading()}")
        for key, value in data.items():
            if isinstance(value, list | tuple) and len(value) > MOST_MEMBERS:
                raise collected(
                    cls.__name__,
                    [((key,), f"there are more than {MOST_MEMBERS} members, the most that are allowed")],
                )
        fields = cls.model_fields
        raw = {key: value for key, value in data.items() if key in fields}
        present = frozenset(key for key, value in raw.items() if value is not None)
        strange = [str(key) for key in data if key not in raw]
        # A key that is still to be given is the likelier meaning of a misspelt one.
        absent = [key for key in fields if key not in present] if strange else []
        meant = {nearest(key, absent) for key in strange[:_MOST_UNKNOWN]}
        faults: list[tuple[Place, str]] = [
            ((key,), unknown("key", key, fields, absent)) for key in strange[:_MOST_UNKNOWN]
        ]
        if len(strange) > _MOST_UNKNOWN:
            faults.append(((), f"{len(strange) - _MOST_UNKNOWN} more keys are unknown; remove them too"))
        if not strange:
            faults += [((), message) for message in _faults_of_ways(cls.ways, present)]
        completed = cls.completed(raw)
        try:
            judged = handler(completed)
        except ValidationError as error:
            otherwise = {key for ways in cls.ways if ways.taken(present) for key in chain(*ways.groups)}
            faults += reworded(error, fields, meant | otherwise if faults or error.error_count() > 1 else ())
            judged = cls._sound_part(completed)
        # What only follows from a value's own fault, or from a misspelt key, is not told.
        broken = {place[:depth] for place, _ in faults for depth in range(1, len(place) + 1)}
        between = [
            (place, message)
            for place, message in judged.faults(raw)
            if place not in broken and meant.isdisjoint(map(str, place[:1]))
        ]
        if faults or between:
            raise collected(cls.__name__, [*faults, *between])
        return judged

    @classmethod
    def _sound_part(cls, data: Mapping[str, object]) -> Self:
        """Return a table without the values that are at fault, which are None in it."""
        sound: PlainTable = {}
        for key, field in cls.model_fields.items():
            value, inner = data.get(key), table_of(cls, key)
            sound[key] = None if key in data or field.is_required() else field.get_default()
            if inner is not None and inner.letter is not None and isinstance(value, list | tuple):
                sound[key] = tuple(
                    inner._sound_part(member)
                    if isinstance(member, Mapping)
                    else (member if isinstance(member, inner) else None)
                    for member in value
                )
            elif key in data:
                with suppress(ValidationError):
                    sound[key] = _reader(cls, key).validate_python(value)
        return super().model_construct(**sound)

    def model_copy(self, *, update: Mapping[str, object] | None = None, deep: bool = False) -> Self:
        """Return a copy with some values replaced, validated like any other.

        A new value in metres takes the place of what was stated on the Earth too.

        Args:
            update: new values by key.
            deep: without meaning here, since everything inside is frozen.

        Raises:
            ScenarioError: when the copy would be faulty.
        """
        values = {key: getattr(self, key) for key in type(self).model_fields}
        for ways in self.ways:
            for key in ways.groups[0] if ways.most > 1 else ():
                values |= dict.fromkeys(ways.others(key) if key in (update or {}) else ())
        return type(self)(**values | dict(update or {}))

    def __getstate__(self) -> PlainTable:
        # Cached arrays stay behind: they would come back writeable.
        state = super().__getstate__()
        return state | {"__dict__": {key: state["__dict__"][key] for key in type(self).model_fields}}

    def __eq__(self, other: object) -> bool:
        # Not pydantic's own comparison, which would meet the cached arrays too.
        return type(self) is type(other) and all(
            getattr(self, key) == getattr(other, key) for key in type(self).model_fields
        )


def read_only(values: ArrayLike, shape: Sequence[int]) -> Floats:
    """Return the values as a float64 array of the given shape that refuses to be written to."""
    array = np.array(values, dtype=np.float64).reshape(shape)
    array.flags.writeable = False
    return array


def optional(description: str, *examples: object) -> Any:
    """Make the field of a key that may be left out, and is None then."""
    return Field(default=None, description=description, examples=list(examples) or None)


@cache
def _faults_of_ways(ways: tuple[Ways, ...], present: frozenset[str]) -> tuple[str, ...]:
    """Collect the faults of the keys that are given, together."""
    return tuple(message for each in ways for message in each.faults(present))


def inner_section(annotation: object) -> type[Section] | None:
    """Return the kind of table that the type of a field holds, or a list of; None if it holds no table."""
    if isinstance(annotation, type) and issubclass(annotation, Section):
        return annotation
    return next(filter(None, map(inner_section, get_args(annotation))), None)


@cache
def table_of(kind: type[Section], key: str) -> type[Section] | None:
    """Return the kind of table that one key of a table holds, or a list of; None if it holds no table.

    Args:
        kind: the table.
        key: one of its keys.
    """
    return inner_section(kind.model_fields[key].annotation)


@cache
def _reader(kind: type[Section], key: str) -> TypeAdapter[object]:
    """Make the reader of one key of a table."""
    return TypeAdapter(kind.model_fields[key].rebuild_annotation())
