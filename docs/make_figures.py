"""Bring the pictures and the page of the paper's claims up to date: `make figures`.

They are what `nullpose reproduce` writes, copied: README and pages show what the program says.
"""

import shutil
from pathlib import Path
from tempfile import TemporaryDirectory

from nullpose.report.reproduce import reproduce

DOCS = Path(__file__).parent


def main() -> None:
    """Run the reproduction and copy its figures and its claims."""
    with TemporaryDirectory() as folder:
        reproduce(Path(folder))
        for name in ("figure2.png", "poses.png"):
            shutil.copyfile(Path(folder) / name, DOCS / "images" / name)
        shutil.copyfile(Path(folder) / "claims.md", DOCS / "claims.md")


if __name__ == "__main__":
    main()
