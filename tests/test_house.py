"""The rules of the house that no other tool checks."""

import ast
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterable
from functools import cache
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

from nullpose import __version__

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "nullpose"
TESTS = ROOT / "tests"

MAX_FILE_LINES = 600
MAX_FUNCTION_LINES = 80

# Folders of tests that mirror no room of the source.
OTHER_TESTS = {"benchmarks", "docs", "examples", "reference"}

DEFINITIONS = ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef

# Written so that no pattern matches itself.
UNFINISHED = re.compile(r"\b(?:TO[D]O|FIX[M]E|XX[X]|HAC[K])\b")
MACHINE = re.compile(
    r"/(?:work|root|home)/\w|/tmp/\w|pythonhost[e]d|jsdeliv[r]|unpk[g]|cdn[.]\w", re.IGNORECASE
)


def _tracked_files() -> list[Path]:
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True)
    return [ROOT / name for name in listed.stdout.split("\0") if name and (ROOT / name).is_file()]


def _tracked_text() -> dict[Path, str]:
    binary = {".png", ".jpg", ".gif", ".webp", ".pdf", ".npz", ".gz", ".shp", ".shx", ".dbf"}
    files = [path for path in _tracked_files() if path.suffix not in binary and path.name != "LICENSE"]
    return {path: path.read_text(encoding="utf-8") for path in files}


def _hits(pattern: re.Pattern[str], suffixes: set[str] | None = None) -> list[str]:
    return [
        f"{path.relative_to(ROOT)}:{number}: {line.strip()[:100]}"
        for path, text in _tracked_text().items()
        if suffixes is None or path.suffix in suffixes
        for number, line in enumerate(text.splitlines(), start=1)
        if pattern.search(line)
    ]


def _source_files() -> list[Path]:
    return sorted(SOURCE.rglob("*.py"))


def _rooms() -> set[str]:
    return {folder.name for folder in SOURCE.iterdir() if any(folder.glob("[!_]*.py"))}


def test_files_are_short() -> None:
    """No Python file, tests and benchmarks included, is longer than the limit."""
    python = [path for path in _tracked_files() if path.suffix == ".py"]
    lengths = {path: len(path.read_text(encoding="utf-8").splitlines()) for path in python}
    assert {str(path): lines for path, lines in lengths.items() if lines > MAX_FILE_LINES} == {}


def test_functions_are_short() -> None:
    """No function of the source has more lines of code, docstring and comments left out, than the limit."""
    offenders = []
    for path in _source_files():
        text = path.read_text(encoding="utf-8")
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                docstring = ast.get_docstring(node, clean=False)
                first = (node.body[0].end_lineno or 0) if docstring is not None else node.lineno - 1
                body = (line.strip() for line in text.splitlines()[first : node.end_lineno])
                lines = sum(1 for line in body if line and not line.startswith("#"))
                if lines > MAX_FUNCTION_LINES:
                    offenders.append(f"{path.relative_to(ROOT)}:{node.lineno} {node.name}: {lines}")
    assert offenders == []


def test_public_names_say_what_they_are() -> None:
    """Every module, and every public class, function and method in it, has a docstring of some words."""
    offenders = []
    for path in _source_files():
        module = ast.parse(path.read_text(encoding="utf-8"))
        classes = [node for node in module.body if isinstance(node, ast.ClassDef) and node.name[0] != "_"]
        members = [
            node for scope in (module, *classes) for node in scope.body if isinstance(node, DEFINITIONS)
        ]
        members = [node for node in members if "overload" not in map(ast.unparse, node.decorator_list)]
        for node in (module, *(member for member in members if member.name[0] != "_")):
            first_line = (ast.get_docstring(node) or "").split("\n")[0]
            if len(first_line.split()) < 2:
                offenders.append(f"{path.relative_to(ROOT)}: {getattr(node, 'name', 'the module')}")
    assert offenders == []


def test_every_room_is_tested() -> None:
    """Each room of the source that has code has a folder of tests."""
    assert {room for room in _rooms() if not any((TESTS / room).rglob("test_*.py"))} == set()


def test_tests_mirror_the_source() -> None:
    """A test in a room's folder is named after a module of that room, or after one and what it asks of it."""
    offenders = []
    for folder in sorted(path for path in TESTS.iterdir() if path.is_dir() and any(path.rglob("test_*.py"))):
        if folder.name in OTHER_TESTS:
            continue
        modules = {path.stem for path in (SOURCE / folder.name).rglob("*.py")}
        modules |= {path.name for path in (SOURCE / folder.name).rglob("*") if path.is_dir()}
        for test in folder.rglob("test_*.py"):
            subject = test.stem.removeprefix("test_")
            if not any(subject == module or subject.startswith(f"{module}_") for module in modules):
                offenders.append(str(test.relative_to(ROOT)))
    assert offenders == []


def _imported(files: Iterable[Path]) -> set[str]:
    """Return the packages that files import, but for those of Python and of the repository."""
    nodes = [node for path in files for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))]
    modules = {name.name for node in nodes if isinstance(node, ast.Import) for name in node.names}
    modules |= {node.module or "" for node in nodes if isinstance(node, ast.ImportFrom)}
    folders = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["pytest"]["ini_options"][
        "pythonpath"
    ]
    ours = {
        "nullpose",
        *(path.stem for folder in [*folders, "docs/figures"] for path in (ROOT / folder).iterdir()),
    }
    return {module.split(".")[0] for module in modules} - set(sys.stdlib_module_names) - ours


def _required(*extras: str) -> set[str]:
    """Return the distributions that are named as required, by all or by extras and those that they name."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    lines, found = list(project["dependencies"]), set()
    lines += [f"nullpose[{extra}]" for extra in extras]
    while lines:
        name, nested, _ = re.match(r"([\w.-]+)(?:\[([\w,]+)\])?(.*)", lines.pop()).groups()
        found.add(name.lower().replace("_", "-"))
        for extra in (nested or "").split(",") if nested else ():
            lines += project["optional-dependencies"][extra]
    return found


_distributions = cache(packages_distributions)


@pytest.mark.parametrize(
    ("files", "extras"),
    [
        ("src/**/*.py", ["all"]),
        ("tests/**/test_*.py", ["test"]),
        ("tests/studio/browser/*.py", ["studiotest"]),
    ],
)
def test_imported_packages_are_required(files: str, extras: list[str]) -> None:
    """What the source imports is named in an extra, and what tests import in that of their target."""
    distributions = _distributions()
    required = _required(*extras)
    missing = {
        name
        for name in _imported(ROOT.glob(files))
        if not required & {each.lower().replace("_", "-") for each in distributions.get(name, [name])}
    }
    assert missing == set()


def test_nothing_is_left_unfinished() -> None:
    """No tracked file carries a mark of unfinished work."""
    assert _hits(UNFINISHED) == []


def test_no_machine_shows() -> None:
    """No tracked file names a path of the machine it was written on, or a host that pages would load from."""
    assert _hits(MACHINE) == []


def test_pages_name_code_that_exists() -> None:
    """Every Python file that a page names by its folder is there."""
    texts = {path: text for path, text in _tracked_text().items() if path.suffix == ".md"}
    named = {
        (path, name) for path, text in texts.items() for name in re.findall(r"`((?:\w+/)+\w+\.py)`", text)
    }
    missing = [
        (path.name, name)
        for path, name in named
        if not any((folder / name).is_file() for folder in (ROOT, SOURCE, path.parent))
    ]
    assert named
    assert missing == []


def test_licence_is_the_one_stated() -> None:
    """The licence in the metadata, in CITATION.cff and in LICENSE is the same."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    licence = (ROOT / "LICENSE").read_text(encoding="utf-8")
    assert project["license"] == "Apache-2.0"
    assert "Apache License" in licence.splitlines()[1]
    assert "Version 2.0, January 2004" in licence.splitlines()[2]
    assert licence.rstrip().endswith("limitations under the License.")
    assert "license: Apache-2.0" in (ROOT / "CITATION.cff").read_text(encoding="utf-8").splitlines()


def test_version_is_the_same_everywhere() -> None:
    """The package and CITATION.cff state the same version."""
    assert f"version: {__version__}" in (ROOT / "CITATION.cff").read_text(encoding="utf-8").splitlines()
