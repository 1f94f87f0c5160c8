"""The folder of a study: a manifest, parts with their checksums, and nothing that is half written."""

from __future__ import annotations

import hashlib
import json
import os
import stat
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

from nullpose.errors import OutputError, UsageError
from nullpose.files import parse_json, read_bytes, refusals, replacing, write_text
from nullpose.objectives import RECORDS, Quantity
from nullpose.study.monte_carlo.chunk import Done, Part
from nullpose.study.monte_carlo.draw import quantity_of
from nullpose.study.monte_carlo.spec import StudySpec
from nullpose.study.monte_carlo.versions import versions

__all__ = ["FORMAT", "QUANTITIES", "Store"]

FORMAT = 1  # version of the folder's layout
MANIFEST, JOURNAL, PARTS = "manifest.json", "parts.jsonl", "parts"

_MOST_BYTES = 64_000_000  # of a manifest, which holds what all scenario files of the study say
_LONGEST_LINE = 4096  # characters of the journal's
_MOST = 10**15  # above all counts that there are
_KEYS: dict[str, type] = {
    "name": str,
    "objective": str,
    "scenes": int,
    "chunk": int,
    "spec_sha256": str,
    "versions": dict,
    "spec": dict,
}

# What a study makes as large as it can be, by the name in its manifest: an objective, or what nodes may have
# under it instead.
QUANTITIES: dict[str, Quantity] = {
    quantity.name.replace("_", "-") if place else record.name: quantity
    for record in RECORDS.values()
    for place, quantity in enumerate(record.quantities)
}


class Store:
    """A study's folder.

    Args:
        folder: where it is.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.parts_folder = folder / PARTS
        self._journal = folder / JOURNAL

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
        if wrong or content["objective"] not in QUANTITIES:
            raise UsageError(f"{path}: {[*wrong, 'objective'][0]} is missing or wrong; restore this manifest")
        return content

    def is_begun(self) -> bool:
        """Return whether a study has a manifest here."""
        return (self.folder / MANIFEST).exists()

    def begin(self, spec: StudySpec, chunk: int) -> None:
        """Write the manifest of a new study.

        Args:
            spec: the study.
            chunk: scenes of a part.

        Raises:
            OutputError: the folder cannot be written.
        """
        quantity = quantity_of(spec)
        manifest = {
            "format": FORMAT,
            "name": spec.name,
            "objective": next(name for name, one in QUANTITIES.items() if one == quantity),
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

    def require_same(self, spec: StudySpec) -> dict[str, Any]:
        """Return the manifest of the study that is here, if it is this one.

        Args:
            spec: the study.

        Raises:
            UsageError: another study is here, or this one begun by another nullpose.
        """
        manifest = self.manifest()
        if manifest["spec_sha256"] != spec.digest:
            before, now = manifest["spec"], spec.to_dict()
            keys = sorted(key for key in {*before, *now} - {"name"} if before.get(key) != now.get(key))
            raise UsageError(
                f"{self.folder}: another study is here (not the same: {', '.join(keys)}); choose another "
                "folder with --out, or give the spec as it was"
            )
        begun, here = manifest["versions"].get("nullpose"), versions()["nullpose"]
        if begun != here:
            raise UsageError(
                f"{self.folder}: this study was begun with nullpose {begun}, and this is {here}; "
                "go on with that version, or choose another folder with --out"
            )
        return manifest

    def parts(self) -> list[Part]:
        """Return the parts that the journal lists, in order; of lines about one part the last counts."""
        found = {part.first: part for part in self._listed()}
        return [found[first] for first in sorted(found)]

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
        listed = self.parts()
        kept = [part for part in listed if self.is_whole(part)]
        lines = "".join(_line_of(part) for part in kept)
        names = {part.name for part in kept}
        with refusals(f"cannot write {self._journal}"):
            self.parts_folder.mkdir(exist_ok=True)
            if (self._journal.read_text(errors="replace") if self._journal.exists() else "") != lines:
                write_text(self._journal, lines)
            left = [path for path in self.parts_folder.iterdir() if path.name not in names]
            for path in [*left, *self.folder.glob(".manifest.*"), *self.folder.glob(".parts.*")]:
                path.unlink()
        return kept, len(listed) - len(kept)

    def add(self, done: Done) -> Part:
        """Write a part whole, then list it; return what was listed.

        Args:
            done: from a worker, with a part.

        Raises:
            OutputError: it cannot be written; nothing of it is left then.
        """
        assert done.part is not None, "a worker's fault is told before"
        path = self.parts_folder / done.part.name
        with replacing(path) as temporary, temporary.open("wb") as file:
            file.write(done.content)
            file.flush()
            os.fsync(file.fileno())
        try:
            with refusals(f"cannot write {self._journal}"):
                _append(self._journal, _line_of(done.part).encode())
        except OutputError:
            with suppress(OSError):
                path.unlink()
            raise
        return done.part

    def _listed(self) -> Iterator[Part]:
        try:
            if not stat.S_ISREG(self._journal.stat().st_mode):
                raise UsageError(f"{self._journal}: is no regular file; restore it")
            with self._journal.open(encoding="utf-8", errors="replace") as file:
                for line in iter(lambda: file.readline(_LONGEST_LINE), ""):
                    with suppress(ValueError):  # a line that a killed client did not finish
                        yield Part.model_validate_json(line)
        except FileNotFoundError:
            return
        except OSError as error:
            raise UsageError(f"{self._journal}: cannot be read: {error.strerror or error}") from None


def _line_of(part: Part) -> str:
    return part.model_dump_json() + "\n"


def _append(path: Path, line: bytes) -> None:
    """Add a line to a file, or leave the file as it was."""
    with path.open("ab", buffering=0) as file:
        before = file.seek(0, os.SEEK_END)
        try:
            if file.write(line) != len(line):
                raise OSError("No space left on device")
            os.fsync(file.fileno())
        except OSError:
            file.truncate(before)
            raise
