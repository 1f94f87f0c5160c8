"""The folder of a study: a manifest, parts with their checksums, and nothing that is half written."""

from __future__ import annotations

import hashlib
import json
import os
import stat
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from nullpose.errors import OutputError, UsageError
from nullpose.files import parse_json, read_bytes, refusals, replacing, write_text
from nullpose.study.monte_carlo.chunk import Done
from nullpose.study.monte_carlo.spec import StudySpec
from nullpose.study.monte_carlo.versions import versions

__all__ = ["FORMAT", "Part", "Store", "objective_name"]

FORMAT = 1
"""Version of the folder's layout."""

MANIFEST, JOURNAL, PARTS = "manifest.json", "parts.jsonl", "parts"

_MOST_BYTES = 64_000_000  # of a manifest, which holds what all scenario files of the study say
_LONGEST_LINE = 4096  # characters of the journal's
_MOST = 10**15  # above all counts that there are, and below what a float cannot hold
_OBJECTIVES = ("min-sinr", "min-margin", "secrecy-rate")
_KEYS: dict[str, type] = {
    "name": str,
    "objective": str,
    "scenes": int,
    "chunk": int,
    "spec_sha256": str,
    "versions": dict,
    "spec": dict,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """A finished part, as the journal has it.

    Args:
        first: its first scene.
        last: its last scene.
        rows: how many rows it has.
        failed: how many of them are failures.
        seconds: how long a worker took for it.
        size: the file's size in bytes.
        sha256: the file's checksum.
    """

    first: int
    last: int
    rows: int
    failed: int
    seconds: float
    size: int
    sha256: str

    @property
    def is_sound(self) -> bool:
        """Whether the values are of their types, and the scenes in order."""
        counts = (self.first, self.last, self.rows, self.failed, self.size)
        return (
            all(type(count) is int and 0 <= count < _MOST for count in counts)
            and self.last >= self.first
            and isinstance(self.seconds, int | float)
            and 0.0 <= self.seconds < _MOST
            and isinstance(self.sha256, str)
        )

    @property
    def name(self) -> str:
        """The file's name."""
        return part_name(self.first, self.last)


def part_name(first: int, last: int) -> str:
    """Return the name of the part of some scenes.

    Args:
        first: the first scene.
        last: the last scene.
    """
    return f"part-{first:09d}-{last:09d}.parquet"


def objective_name(spec: StudySpec) -> str:
    """Return what a study's values are: min-sinr, min-margin or secrecy-rate.

    Args:
        spec: the study.
    """
    tables = spec.scene.tables(0)
    if tables.get("objective", "min-sinr") == "secrecy-rate":
        return "secrecy-rate"
    weighed = spec.nodes is not None and (spec.nodes.weight is not None or spec.nodes.min_sinr_db is not None)
    stated = spec.nodes is None and any(
        "weight" in node or "min_sinr_db" in node
        for index in range(spec.scene.size)
        for node in spec.scene.tables(index).get("nodes", ())
    )
    swept = any(path.rsplit(".", 1)[-1] in ("weight", "min_sinr_db") for path in spec.swept)
    return "min-margin" if weighed or stated or swept else "min-sinr"


class Store:
    """A study's folder.

    Args:
        folder: where it is.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    @property
    def parts_folder(self) -> Path:
        """Where the parts are."""
        return self.folder / PARTS

    def manifest(self) -> dict[str, Any]:
        """Return the manifest.

        Raises:
            UsageError: there is none, or none that can be read.
        """
        path = self.folder / MANIFEST
        try:
            content = parse_json(read_bytes(path, _MOST_BYTES).decode())
        except FileNotFoundError:
            raise UsageError(
                f"{self.folder}: no study is here ({MANIFEST} is missing); name the folder given to "
                "nullpose study run --out"
            ) from None
        except (OSError, ValueError) as error:
            raise UsageError(f"{path}: this manifest cannot be read ({error}); restore it") from None
        if not isinstance(content, dict) or content.get("format") != FORMAT:
            raise UsageError(
                f"{path}: made by a nullpose with another format of studies; use that one, or another folder"
            )
        wrong = [key for key, kind in _KEYS.items() if not isinstance(content.get(key), kind)]
        wrong = wrong or [key for key in ("scenes", "chunk") if not 1 <= content[key] < _MOST]
        if wrong or content["objective"] not in _OBJECTIVES:
            raise UsageError(f"{path}: {[*wrong, 'objective'][0]} is missing or wrong; restore this manifest")
        return content

    def is_begun(self) -> bool:
        """Return whether a study has a manifest here."""
        return (self.folder / MANIFEST).exists()

    def begin(self, spec: StudySpec, chunk: int) -> dict[str, Any]:
        """Write the manifest of a new study, and return it.

        Args:
            spec: the study.
            chunk: scenes of a part.

        Raises:
            OutputError: the folder cannot be written.
        """
        manifest = {
            "format": FORMAT,
            "name": spec.name,
            "objective": objective_name(spec),
            "seed": spec.seed,
            "scenes": spec.n_scenes,
            "points": len(spec.points),
            "cases": list(spec.case_names),
            "swept": list(spec.swept),
            "chunk": chunk,
            "spec_sha256": spec.digest,
            "versions": versions(),
            "spec": spec.to_dict(),
        }
        write_text(self.folder / MANIFEST, json.dumps(manifest, indent=1) + "\n")
        return manifest

    def require_same(self, spec: StudySpec) -> dict[str, Any]:
        """Return the manifest of the study that is here, if it is this one.

        Args:
            spec: the study.

        Raises:
            UsageError: another study is here, or this one begun by another nullpose.
        """
        manifest = self.manifest()
        if manifest["spec_sha256"] != spec.digest:
            raise UsageError(
                f"{self.folder}: another study is here{_difference(manifest['spec'], spec.to_dict())}; "
                "choose another folder with --out, or give the spec as it was"
            )
        begun, here = manifest["versions"].get("nullpose"), versions()["nullpose"]
        if begun != here:
            raise UsageError(
                f"{self.folder}: this study was begun with nullpose {begun}, and this is {here}; "
                "go on with that version, or choose another folder with --out"
            )
        return manifest

    def listed(self) -> dict[int, Part]:
        """Return the parts of the journal by their first scene; of lines about one part the last counts."""
        found: dict[int, Part] = {}
        for part in self._journal():
            found[part.first] = part
        return found

    def is_whole(self, part: Part) -> bool:
        """Return whether a part's file has the size and the checksum that the journal says.

        Args:
            part: as listed.
        """
        path = self.parts_folder / part.name
        try:
            if not path.is_file() or path.stat().st_size != part.size:
                return False
            with path.open("rb") as file:
                return hashlib.file_digest(file, "sha256").hexdigest() == part.sha256
        except OSError:
            return False

    def mend(self) -> tuple[list[Part], int]:
        """Return the parts that are whole, and how many are to be redone; take away what is not listed.

        What a killed client or a full disk left is removed: temporary files, parts that never got into the
        journal, a journal's line that was cut off, damaged parts.

        Raises:
            OutputError: the folder cannot be written.
        """
        listed = self.listed()
        kept = [part for part in listed.values() if self.is_whole(part)]
        lines = "".join(json.dumps(asdict(part)) + "\n" for part in kept)
        names = {part.name for part in kept}
        with refusals(f"cannot write {self.folder / JOURNAL}"):
            self.parts_folder.mkdir(exist_ok=True)
            if not self._journal_is(lines):
                write_text(self.folder / JOURNAL, lines)
            for path in self.parts_folder.iterdir():
                if path.name not in names:
                    path.unlink()
            for path in self.folder.glob(".*"):
                if path.name.startswith((".manifest.", ".parts.")):
                    path.unlink()
        return kept, len(listed) - len(kept)

    def add(self, done: Done) -> Part:
        """Write a part whole, then list it; return what was listed.

        Args:
            done: from a worker.

        Raises:
            OutputError: it cannot be written; nothing of it is left then.
        """
        path = self.parts_folder / part_name(done.first, done.last)
        part = Part(
            first=done.first,
            last=done.last,
            rows=done.rows,
            failed=done.failed,
            seconds=done.seconds,
            size=len(done.content),
            sha256=hashlib.sha256(done.content).hexdigest(),
        )
        with replacing(path) as temporary, temporary.open("wb") as file:
            file.write(done.content)
            file.flush()
            os.fsync(file.fileno())
        try:
            with refusals(f"cannot write {self.folder / JOURNAL}"):
                _append(self.folder / JOURNAL, json.dumps(asdict(part)) + "\n")
        except OutputError:
            with suppress(OSError):
                path.unlink()
            raise
        return part

    def _journal(self) -> Iterator[Part]:
        try:
            if not stat.S_ISREG((self.folder / JOURNAL).stat().st_mode):
                raise UsageError(f"{self.folder / JOURNAL}: is no regular file; restore it")
            with (self.folder / JOURNAL).open(encoding="utf-8", errors="replace") as file:
                for line in iter(lambda: file.readline(_LONGEST_LINE), ""):
                    # a line that a killed client did not finish
                    with suppress(ValueError, TypeError, RecursionError):
                        part = Part(**json.loads(line))
                        if part.is_sound:
                            yield part
        except FileNotFoundError:
            return
        except OSError as error:
            raise UsageError(f"{self.folder / JOURNAL}: cannot be read: {error.strerror or error}") from None

    def _journal_is(self, lines: str) -> bool:
        try:
            return (self.folder / JOURNAL).read_bytes() == lines.encode()
        except FileNotFoundError:
            return not lines


def _append(path: Path, line: str) -> None:
    """Add a line to a file, or leave the file as it was."""
    with path.open("ab", buffering=0) as file:
        before = file.seek(0, os.SEEK_END)
        try:
            if file.write(line.encode()) != len(line.encode()):
                raise OSError("No space left on device")
            os.fsync(file.fileno())
        except OSError:
            file.truncate(before)
            raise


def _difference(before: dict[str, Any], now: dict[str, Any]) -> str:
    """Return in words which keys differ between two specs."""
    keys = [key for key in {**before, **now} if before.get(key) != now.get(key) and key != "name"]
    return f" (its {', '.join(sorted(keys))} {'differs' if len(keys) == 1 else 'differ'})" if keys else ""
