"""What may become of a file on its way: bytes lost or changed, values of other kinds, things said twice."""

from __future__ import annotations

import random
import re
from collections.abc import Callable

__all__ = ["MUTATIONS", "mutated"]

Mutation = Callable[[bytes, random.Random], bytes]

_WORD = re.compile(rb"[\w.+-]+|\"[^\"\n]*\"")
_NUMBER = re.compile(rb"(?<![\w.\"])-?\d+(?:\.\d+)?(?:e-?\d+)?(?![\w\"])")
_OTHERS = (
    *(
        b"0",
        b"-1",
        b"1",
        b"10000",
        b"10001",
        b"1e308",
        b"-1e308",
        b"1e-320",
        b"1e999",
        b"nan",
        b"inf",
        b"NaN",
    ),
    *(b"-Infinity", b"0x7fffffffffffffff", b"9223372036854775808", b"1" + b"0" * 400, b"9" * 5000, b"0.1.2"),
    *(b"true", b"null", b"2020-01-01", b"''", b'""', b'"text"', b'"\\u0000"', b'"' + b"x" * 20_000 + b'"'),
    *(b"[]", b"{}", b"[[[]]]", b"[1, 2]", b'{"a": 1}', b"{a = 1}", b"[{}, {}]", b"[" * 100_000, b"\x00"),
    *(b"\xff\xfe", "ü".encode(), b"\r", b"a." * 50_000 + b"a", b'"/etc/passwd"', b'"../x.csv"', b",", b"="),
)


def mutated(content: bytes, random_source: random.Random) -> bytes:
    """Return a file's content after one to four mutations.

    Args:
        content: the content of a sound file.
        random_source: decides which, and where.
    """
    for _ in range(random_source.randint(1, 4)):
        content = random_source.choice(MUTATIONS)(content, random_source)
    return content


def _flip(content: bytes, random_source: random.Random) -> bytes:
    damaged = bytearray(content)
    for _ in range(random_source.randint(1, 5) if damaged else 0):
        damaged[random_source.randrange(len(damaged))] = random_source.randrange(256)
    return bytes(damaged)


def _cut(content: bytes, random_source: random.Random) -> bytes:
    return content[: random_source.randint(0, len(content))]


def _take_out(content: bytes, random_source: random.Random) -> bytes:
    first, last = sorted(random_source.randint(0, len(content)) for _ in range(2))
    return content[:first] + content[min(last, first + 200) :]


def _say_twice(content: bytes, random_source: random.Random) -> bytes:
    """Repeat a line, or a few bytes."""
    lines = content.splitlines(keepends=True)
    if len(lines) > 1 and random_source.random() < 0.7:
        place = random_source.randrange(len(lines))
        return b"".join((*lines[: place + 1], *lines[place:]))
    first = random_source.randint(0, len(content))
    return content[: first + 30] + content[first:]


def _repeat(content: bytes, random_source: random.Random) -> bytes:
    """Repeat a few bytes very often."""
    first = random_source.randint(0, len(content))
    return content[:first] + content[first : first + 12] * 5000 + content[first:]


def _swap(content: bytes, random_source: random.Random) -> bytes:
    """Exchange two words."""
    words = list(_WORD.finditer(content))
    if len(words) < 2:
        return content
    one, other = sorted(random_source.sample(words, 2), key=lambda word: word.start())
    between = content[one.end() : other.start()]
    return content[: one.start()] + other[0] + between + one[0] + content[other.end() :]


def _other_value(content: bytes, random_source: random.Random) -> bytes:
    """Put something else in the place of a word, or of a number."""
    words = list((_NUMBER if random_source.random() < 0.6 else _WORD).finditer(content))
    if not words:
        return content + random_source.choice(_OTHERS)
    word = random_source.choice(words)
    return content[: word.start()] + random_source.choice(_OTHERS) + content[word.end() :]


MUTATIONS: tuple[Mutation, ...] = (
    *(_flip, _cut, _take_out, _say_twice, _repeat, _swap),
    *(_other_value,) * 6,
)
"""What can happen to a file; other values are the likeliest, the rest mostly ends in the first check."""
