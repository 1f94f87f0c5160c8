"""The folder of a study: a manifest, parts with their checksums, and nothing that is half written."""

from __future__ import annotations

import hashlib
import json
import os
from contextlib import suppress
from pathlib import Path
from typing import Any

from nullpose.errors import UsageError
from nullpose.files import parse_json, read_bytes, refusals, replacing, write_text
from nullpose.objectives import RECORDS, Quantity
from nullpose.study.monte_carlo.chunk import Part
from nullpose.study.monte_carlo.draw import quantity_of
from nullpose.study.monte_carlo.spec import StudySpec
from nullpose.study.monte_carlo.versions import versions

FORMAT = 2  # version of the folder's layout
MANIFEST, JOURNAL, PARTS = "manifest.json", "parts.jsonl", "parts"

_MOST_BYTES = 64_000_000  # of a manifest, which holds what all scenario files of the study say
_LONGEST_JOURNAL = 10**10  # bytes, of some 200 for each part
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
        """Return the parts that the journal lists, in order; of lines about one part the last counts.

        Raises:
            UsageError: the journal cannot be read.
        """
        try:
            text = read_bytes(self._journal, _LONGEST_JOURNAL).decode(errors="replace")
        except FileNotFoundError:
            return []
        except OSError as error:
            raise UsageError(f"{self._journal}: cannot be read: {error.strerror or error}") from None
        found: dict[int, Part] = {}
        for line in text.splitlines():
            with suppress(ValueError):  # a line that a killed client did not finish
                part = Part.model_validate_json(line)
                found[part.first] = part
        return [part for _, part in sorted(found.items()) if part.scenes > 0]

    def content_of(self, part: Part) -> bytes | None:
        """Return what a part's file holds; None if it has not the size and checksum that the journal says.

        Args:
            part: as listed.
        """
        try:
            content = read_bytes(self.parts_folder / part.name, part.size)
        except OSError:
            return None
        return content if hashlib.sha256(content).hexdigest() == part.sha256 else None

    def mend(self) -> tuple[list[Part], int]:
        """Return the parts that are whole, and how many are to be redone; take away what is not listed.

        What a killed client or a full disk left is removed: temporary files, parts that never got into the
        journal, a journal's line that was cut off, damaged parts.

        Raises:
            OutputError: the folder cannot be written.
        """
        listed = self.parts()
        kept = [part for part in listed if self.content_of(part) is not None]
        lines = "".join(_line_of(part) for part in kept)
        names = {part.name for part in kept}
        with refusals(f"cannot write {self._journal}"):
            self.parts_folder.mkdir(exist_ok=True)
            if (self._journal.read_text("utf-8", "replace") if self._journal.exists() else "") != lines:
                write_text(self._journal, lines)
            left = [path for path in self.parts_folder.iterdir() if path.name not in names]
            for path in [*left, *self.folder.glob(".manifest.*"), *self.folder.glob(".parts.*")]:
                path.unlink()
        return kept, len(listed) - len(kept)

    def add(self, part: Part, content: bytes) -> None:
        """Write a part whole, then list it.

        What is left of a line that cannot be written is no part, and the next run takes it away.

        Args:
            part: from a worker.
            content: of its file.

        Raises:
            OutputError: it cannot be written.
        """
        with replacing(self.parts_folder / part.name) as temporary:
            _write(temporary, "wb", content)
        with refusals(f"cannot write {self._journal}"):
            _write(self._journal, "ab", _line_of(part).encode())


def _line_of(part: Part) -> str:
    return part.model_dump_json() + "\n"


def _write(path: Path, mode: str, content: bytes) -> None:
    """Write to a file, and wait until it is on disk."""
    with path.open(mode) as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())
