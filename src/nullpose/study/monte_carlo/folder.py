"""The folder of a study: a manifest, and parts that are there whole or not at all."""

from __future__ import annotations

import json
import os
import re
import socket
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import IO

from nullpose.errors import OutputError, UsageError, install_command, require_usage
from nullpose.files import PlainTable, check_outputs, parse_json, read_bytes, refusals, replacing, write_text
from nullpose.objectives import RECORDS, Quantity
from nullpose.study.monte_carlo.draw import quantity_of
from nullpose.study.monte_carlo.rows import read_counts, read_parquet
from nullpose.study.monte_carlo.spec import StudySpec

FORMAT = 3  # version of the folder's layout
MANIFEST, PARTS, LOCK = "manifest.json", "parts", "lock"

_PACKAGES = ("pyarrow", "pandas", "xarray", "jinja2")  # that studies need beside those of nullpose
_MOST_BYTES = 64_000_000  # of a manifest, which holds the scenario files of the study
_LONGEST_OWNER = 300  # characters of a lock that are read
_NAME = re.compile(r"part-(\d{9})-(\d{9})\.parquet", re.ASCII)
_KEYS: dict[str, type] = {
    "name": str,
    "objective": str,
    "scenes": int,
    "chunk": int,
    "spec_sha256": str,
    "versions": dict,
    "spec": dict,
}

# The maximised quantities by their names in a manifest: an objective's, or that of nodes with requirements.
QUANTITIES: dict[str, Quantity] = {
    quantity.name.replace("_", "-") if place else record.name: quantity
    for record in RECORDS.values()
    for place, quantity in enumerate(record.quantities)
}


@dataclass(frozen=True, slots=True)
class PartFile:
    """A file with the rows of some scenes.

    Args:
        path: the file.
        first: number of the first scene.
        last: number of the last scene.
    """

    path: Path
    first: int
    last: int

    @property
    def scenes(self) -> int:
        """Number of scenes."""
        return self.last - self.first + 1


class Folder:
    """A study's folder.

    Args:
        path: where it is.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.parts_folder = path / PARTS

    def manifest(self) -> PlainTable:
        """Read the manifest.

        Raises:
            UsageError: there is none, or none that can be read.
        """
        path = self.path / MANIFEST
        try:
            content = parse_json(read_bytes(path, _MOST_BYTES).decode())
        except FileNotFoundError:
            raise UsageError(
                f"{self.path}: no study is here ({MANIFEST} is missing); name the folder given to "
                "nullpose study run --out"
            ) from None
        except (OSError, ValueError) as error:
            raise UsageError(f"{path}: this manifest cannot be read ({error}); restore it") from None
        require_usage(
            isinstance(content, dict) and content.get("format") == FORMAT,
            f"{path}: made by a nullpose with another format of studies; use that one, or another folder",
        )
        wrong = [key for key, kind in _KEYS.items() if not isinstance(content.get(key), kind)]
        wrong = wrong or [key for key in ("scenes", "chunk") if not 1 <= content[key] < 10**9]
        require_usage(
            not wrong and content["objective"] in QUANTITIES,
            f"{path}: {[*wrong, 'objective'][0]} is missing or wrong; restore this manifest",
        )
        return dict(content)

    @property
    def has_manifest(self) -> bool:
        """Whether a study was started here."""
        return (self.path / MANIFEST).exists()

    def write_manifest(self, spec: StudySpec, chunk: int, versions: Mapping[str, str]) -> None:
        """Start a new study.

        Args:
            spec: the study.
            chunk: scenes of a part.
            versions: of the software.

        Raises:
            OutputError: the folder cannot be written.
        """
        quantity = quantity_of(spec)
        manifest = {
            "format": FORMAT,
            "name": spec.name,
            "objective": next(name for name, other in QUANTITIES.items() if other == quantity),
            "seed": spec.seed,
            "scenes": spec.n_scenes,
            "points": len(spec.points),
            "cases": list(spec.case_names),
            "swept": list(spec.swept),
            "chunk": chunk,
            "spec_sha256": spec.digest,
            "versions": dict(versions),
            "spec": spec.to_dict(),
        }
        write_text(self.path / MANIFEST, json.dumps(manifest, indent=1) + "\n")

    def require_same(self, spec: StudySpec, version: str) -> None:
        """Refuse another study in the folder, or one by another nullpose.

        Args:
            spec: the study.
            version: of nullpose.

        Raises:
            UsageError: the folder has another study.
        """
        if (manifest := self.manifest())["spec_sha256"] != spec.digest:
            before, now = manifest["spec"], spec.to_dict()
            keys = sorted(key for key in {*before, *now} - {"name"} if before.get(key) != now.get(key))
            raise UsageError(
                f"{self.path}: another study is here (not the same: {', '.join(keys)}); choose another "
                "folder with --out, or give the spec as it was"
            )
        before_version = manifest["versions"].get("nullpose")
        require_usage(
            before_version == version,
            f"{self.path}: this study was begun with nullpose {before_version}, and this is {version}; "
            "go on with that version, or choose another folder with --out",
        )

    def parts(self) -> list[PartFile]:
        """List the parts in order: files whose names say scenes of this study in its own parts."""
        manifest = self.manifest()
        scenes, chunk = manifest["scenes"], manifest["chunk"]
        parts = []
        for path in sorted(self.parts_folder.glob("part-*")):
            name = _NAME.fullmatch(path.name)
            first, last = map(int, name.groups()) if name else (-1, -1)
            if first % chunk == 0 and last == min(first + chunk, scenes) - 1 and path.is_file():
                parts.append(PartFile(path, first, last))
        return parts

    def clean(self, spec: StudySpec) -> tuple[list[PartFile], int]:
        """Remove all but sound parts; return these and the number of damaged ones.

        A killed run or a full disk leaves temporary files.

        Raises:
            OutputError: the folder cannot be written.
        """
        parts = self.parts()
        sound = [part for part in parts if _is_sound(spec, part)]
        paths = {part.path for part in sound}
        with refusals(f"cannot write to {self.parts_folder}"):
            self.parts_folder.mkdir(exist_ok=True)
            for path in [*self.parts_folder.iterdir(), *self.path.glob(".manifest.*")]:
                if path not in paths:
                    path.unlink()
        return sound, len(parts) - len(sound)

    def add(self, first: int, last: int, content: bytes) -> PartFile:
        """Write a part: under a temporary name, to the disk, then renamed.

        Raises:
            OutputError: it cannot be written.
        """
        part = PartFile(self.parts_folder / f"part-{first:09d}-{last:09d}.parquet", first, last)
        with replacing(part.path) as temporary, temporary.open("wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        return part

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Hold the folder in the block, so that a second run of the study is refused.

        The system frees the lock however a process ends. Where a file system has no locks two runs do the
        same work twice: parts are whole, and equal.

        Raises:
            OutputError: another process holds it.
        """
        path = self.path / LOCK
        check_outputs({}, [("the study's lock", path)])
        with path.open("a+", encoding="utf-8", errors="replace") as file:
            if owner := _other_owner(file):
                raise OutputError(f"{self.path}: {owner} writes this study now; wait for it, or end it")
            file.truncate(0)
            file.write(f"process {os.getpid()} on {socket.gethostname()}")
            file.flush()
            yield
            file.truncate(0)

    @property
    def owner(self) -> str:
        """The process that writes the folder now, as in "process 1234 on host"; empty if there is none."""
        path = self.path / LOCK
        with suppress(OSError):
            if path.is_file():
                with path.open("r+", encoding="utf-8", errors="replace") as file:
                    return _other_owner(file)
        return ""


def require_extra(*more: str) -> None:
    """Refuse to go on without the packages that studies need.

    Args:
        more: further packages that are needed.

    Raises:
        UsageError: a package is missing.
    """
    missing = [name for name in (*_PACKAGES, *more) if find_spec(name) is None]
    require_usage(
        not missing,
        f"a study needs {', '.join(missing)}, not installed here; {install_command('study')}",
    )


def _is_sound(spec: StudySpec, part: PartFile) -> bool:
    try:
        read_counts(part.path)
        read_parquet(spec, part.path)
    except ValueError:
        return False
    return True


def _other_owner(file: IO[str]) -> str:
    """Take the system's lock on a file, or read who has it."""
    try:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        file.seek(0)
        return file.read(_LONGEST_OWNER).strip() or "another process"
    except (ImportError, OSError):  # no locks on Windows, or on this file system
        pass
    return ""
