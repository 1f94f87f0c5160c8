"""Text on standard output and standard error, whatever their encoding and their width."""

from __future__ import annotations

import codecs
import io
import sys
import unicodedata
from shutil import get_terminal_size
from textwrap import TextWrapper

_PLAIN = {"\N{MINUS SIGN}": "-", "\N{EN DASH}": "-", "\N{EM DASH}": "-", "\N{INFINITY}": "inf"}


def replace_lacking_letters() -> None:
    """Have standard output and standard error write other letters for those that their encoding lacks.

    A minus sign becomes a hyphen, an accented letter loses its accent, and what has no likeness in ASCII
    becomes a question mark.
    """
    codecs.register_error("nullpose", _in_ascii)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="nullpose")


def _in_ascii(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    letters = error.object[error.start : error.end]
    likeness = (unicodedata.normalize("NFKD", _PLAIN.get(letter, letter)) for letter in letters)
    return "".join(each.encode("ascii", "ignore").decode() or "?" for each in likeness), error.end


def say(text: str, *, err: bool = False, broken: bool = True) -> None:
    """Print a text; on a terminal the lines of sentences end between words.

    Args:
        text: one line or several, which may be indented.
        err: whether it goes to standard error.
        broken: whether its lines may be broken, which those of JSON may not.
    """
    stream = sys.stderr if err else sys.stdout
    if broken and stream.isatty():
        wrapper = TextWrapper(get_terminal_size().columns, break_long_words=False, break_on_hyphens=False)
        text = "\n".join(wrapper.fill(line) for line in text.split("\n"))
    print(text, file=stream, flush=True)
