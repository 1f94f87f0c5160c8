"""Figures with a dark twin, ``NAME-dark.png`` beside ``NAME.png``, change with the theme of the page."""

from __future__ import annotations

from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.transforms import SphinxTransform


class DarkTwins(SphinxTransform):
    """Adds the twin after each image that has one; the theme shows one of the two."""

    default_priority = 5  # before images are collected

    def apply(self, **kwargs: object) -> None:
        """Add the twins of a page."""
        folder = Path(self.env.srcdir, self.env.docname).parent
        for image in list(self.document.findall(nodes.image)):
            path = Path(image["uri"])
            dark = path.with_name(f"{path.stem}-dark.png")
            if (folder / dark).is_file():
                twin = image.deepcopy()
                twin["uri"] = dark.as_posix()
                for each, theme in ((image, "only-light"), (twin, "only-dark")):
                    each["classes"] = [*each["classes"], theme]
                image.parent.insert(image.parent.index(image) + 1, twin)


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the transform."""
    app.add_transform(DarkTwins)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
