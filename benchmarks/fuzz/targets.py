"""The kinds of files that nullpose reads, sound ones of each, and commands that read them without solving."""

from __future__ import annotations

import gzip
import json
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from nullpose import load, solve
from nullpose.certificate import certificate_text
from nullpose.solver.certificate_from_proof import certificate_of
from nullpose.study.monte_carlo import load_spec, run_study

__all__ = ["Target", "targets"]

EXAMPLES = Path(__file__).parents[2] / "examples"

_SCENE = """
nodes_from = "{nodes}"
[origin]
lat_deg = 50.0
lon_deg = 14.5
alt_m = 230.0
[airspace]
altitude_m = [8.0, 30.0]
[receiver]
noise_w = 1e-3
reference_gain_db = 0.0
"""
_LOCAL = "name,x_m,y_m,z_m,power_dbm,weight\na,1.0,2.0,3.0,20,\nb,-40,20.5,0,17,2\nc,10,-30,1,20,\n"
_GEODETIC = "lat_deg,lon_deg,alt_m,power_w\n50.001,14.501,232,1\n50.002,14.502,231,0.5\n"
_STUDY = """
scenes = 2
gap = 0.1
[scene]
file = "paper.toml"
[jammers]
name = "M"
layout = "poisson"
density_per_m2 = 1e-4
x_m = [-50.0, 50.0]
y_m = [0.0, 80.0]
power_w = { log_uniform = [0.1, 10.0] }
[sweep]
"nodes.*.power_w" = { from = 0.5, to = 2.0, points = 3, spacing = "log" }
[[cases]]
name = "tilt"
airframe = "tilt-10"
"""


@dataclass(frozen=True, slots=True)
class Target:
    """A kind of file.

    Args:
        kind: what it is.
        name: of the file that is damaged, in its folder.
        content: a sound one.
        arguments: of the command that reads it, given the folder.
        beside: the other files that are there, by name.
    """

    kind: str
    name: str
    content: bytes
    arguments: Callable[[Path], tuple[str, ...]]
    beside: dict[str, bytes]

    def written(self, folder: Path, content: bytes) -> tuple[str, ...]:
        """Return the arguments of the command after writing all files, one of them damaged.

        Args:
            folder: an empty one.
            content: of the damaged one.
        """
        for name, each in {**self.beside, self.name: content}.items():
            (folder / name).parent.mkdir(exist_ok=True)
            (folder / name).write_bytes(each)
        return self.arguments(folder)


def targets(folder: Path) -> tuple[Target, ...]:
    """Return the kinds of files; certificates and a study's folder are made here.

    Args:
        folder: where to work, an empty one.
    """
    paper = (EXAMPLES / "paper.toml").read_bytes()
    proof = certificate_text(certificate_of(solve(load(EXAMPLES / "paper.toml"), gap=0.1))).encode()
    geojson = (EXAMPLES / "nodes.geojson").read_bytes()
    pattern = "hexarotor-433mhz.out.gz"
    beside = {"nodes.geojson": geojson, pattern: (EXAMPLES / pattern).read_bytes()}
    csv, geo = (_SCENE.format(nodes=name).encode() for name in ("n.csv", "n.json"))
    return (
        *(
            Target("scenario", "s.toml", path.read_bytes(), _check, beside)
            for path in sorted(EXAMPLES.glob("*.toml"))
            if path.name != "study.toml"
        ),
        Target("CSV nodes", "n.csv", _LOCAL.encode(), _check, {"s.toml": csv}),
        Target("CSV nodes", "n.csv", _GEODETIC.encode(), _check, {"s.toml": csv}),
        Target("GeoJSON nodes", "n.json", geojson, _check, {"s.toml": geo}),
        *(
            Target("study spec", "s.toml", content, _study_run, {"paper.toml": paper, "taken": b""})
            for content in ((EXAMPLES / "study.toml").read_bytes(), _STUDY.encode())
        ),
        *(Target("certificate", "s.json", proof, _verify, {}) for _ in range(2)),
        Target("packed certificate", "s.json", gzip.compress(proof, mtime=0), _verify, {}),
        *_folder_targets(folder, paper),
    )


def _folder_targets(folder: Path, paper: bytes) -> list[Target]:
    """Return the files of a study's folder, of one that has been run."""
    (folder / "paper.toml").write_bytes(paper)
    (folder / "s.toml").write_text(_STUDY, encoding="utf-8")
    run_study(load_spec(folder / "s.toml"), folder / "out", workers=0, chunk=1)
    held = {
        str(path.relative_to(folder)): path.read_bytes()
        for path in (folder / "out" / "manifest.json", *sorted((folder / "out" / "parts").iterdir())[:1])
    }
    held["out/lock"] = json.dumps({"pid": 1, "host": "elsewhere"}).encode()
    shutil.rmtree(folder / "out")
    return [
        Target(f"a study's {Path(name).name}", name, content, arguments, held)
        for name, content in held.items()
        for arguments in ((_status, _show) if name.endswith("manifest.json") else (_status,))
    ]


def _check(folder: Path) -> tuple[str, ...]:
    return "check", str(folder / "s.toml")


def _verify(folder: Path) -> tuple[str, ...]:
    return "verify", str(folder / "s.json")


def _study_run(folder: Path) -> tuple[str, ...]:
    """Return a command that judges a spec and then ends, since a file is in the place of its folder."""
    return "study", "run", str(folder / "s.toml"), "--out", str(folder / "taken")


def _status(folder: Path) -> tuple[str, ...]:
    return "study", "status", str(folder / "out")


def _show(folder: Path) -> tuple[str, ...]:
    return "study", "show", str(folder / "out"), "--scene", "0"
