"""The verb ``cite``, and what there is to cite."""

from __future__ import annotations

from nullpose.cli.printing import say
from nullpose.version import __version__

BIBTEX = f"""\
@inproceedings{{bonillalicea2024omnidirectional,
  title     = {{Omnidirectional Multi-Rotor Aerial Vehicle Pose Optimization: a novel approach to physical layer security}},
  author    = {{Bonilla Licea, Daniel and Silano, Giuseppe and Ghogho, Mounir and Saska, Martin}},
  booktitle = {{IEEE International Conference on Acoustics, Speech and Signal Processing (ICASSP)}},
  year      = {{2024}},
  note      = {{arXiv:2401.02848}}
}}
@software{{nullpose,
  title   = {{nullpose}},
  author  = {{{{The nullpose developers}}}},
  version = {{{__version__}}},
  license = {{Apache-2.0}}
}}"""  # noqa: E501  a title stays on one line
"""The paper, for the problem, and nullpose, for the software; the facts are those of CITATION.cff."""


def cite() -> None:
    """Print what to cite, as BibTeX: the paper and nullpose."""
    say(BIBTEX, broken=False)
