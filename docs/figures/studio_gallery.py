"""Pictures of every example in the studio, at two sizes and on a touch phone, light and dark, and sheets.

``python docs/figures/studio_gallery.py [folder] [example ...]`` writes ``<size>-<scheme>/<example>.png`` and
``<size>-<scheme>.png`` into the folder, which is ``out/screens`` if none is given.
"""

from __future__ import annotations

import sys
from itertools import product
from pathlib import Path
from typing import Any

from PIL import Image, ImageDraw
from studio_screens import ROOT, at_rest, opened

from nullpose import load
from nullpose.studio.server import Studio, studio

DEVICES = (((1280, 800), (1920, 1080)), ((390, 844),))  # the sizes of windows of each, and a touch phone
SCHEMES = ("light", "dark")
_NO_SCENE = "study"
_ACROSS, _THUMB_PX, _HEAD_PX = 4, 480, 24


def take(running: Studio, paths: dict[tuple[int, int], Path], scheme: str) -> None:
    """Take pictures of what a studio shows to a browser that opens it.

    Args:
        running: the studio.
        paths: of the pictures, by the size of the browser's window in pixels, which is changed in turn.
        scheme: light or dark.
    """
    views = {size: dict(zip(("width", "height"), size, strict=True)) for size in paths}
    touch = {"has_touch": True, "is_mobile": True} if len(paths) == 1 else {}
    first = next(iter(views.values()))
    with opened(running.address, scale=1.0, viewport=first, color_scheme=scheme, **touch) as page:
        ours: Any = next(reversed(running.pages.values()))
        for size, path in paths.items():
            page.set_viewport_size(views[size])
            at_rest(page, ours.session)
            path.parent.mkdir(parents=True, exist_ok=True)
            page.screenshot(path=path)


def sheet(folder: Path) -> None:
    """Write the contact sheet of a folder's pictures beside it.

    Args:
        folder: with pictures of one size.
    """
    paths = sorted(folder.glob("*.png"))
    pictures = [Image.open(path).convert("RGB") for path in paths]
    high_px = _THUMB_PX * pictures[0].height // pictures[0].width
    rows = -(-len(paths) // _ACROSS)
    whole = Image.new("RGB", (_ACROSS * _THUMB_PX, rows * (high_px + _HEAD_PX)), "white")
    for i, (path, picture) in enumerate(zip(paths, pictures, strict=True)):
        x, y = i % _ACROSS * _THUMB_PX, i // _ACROSS * (high_px + _HEAD_PX)
        ImageDraw.Draw(whole).text((x + 6, y + 6), path.stem, fill="black")
        whole.paste(picture.resize((_THUMB_PX, high_px)), (x, y + _HEAD_PX))
    whole.save(folder.with_suffix(".png"))


if __name__ == "__main__":
    into = Path(sys.argv[1]) if sys.argv[1:] else ROOT / "out" / "screens"
    found = sorted(path.stem for path in (ROOT / "examples").glob("*.toml"))
    for name in sys.argv[2:] or [one for one in found if not one.startswith(_NO_SCENE)]:
        scene = load(ROOT / "examples" / f"{name}.toml", allow_outside=True).still()
        with studio(scene, port=0) as one:
            for sizes, scheme in product(DEVICES, SCHEMES):
                paths = {(w, h): into / f"{w}x{h}-{scheme}" / f"{name}.png" for w, h in sizes}
                take(one, paths, scheme)
    for folder in {path.parent for path in into.glob("*x*-*/*.png")}:
        sheet(folder)
