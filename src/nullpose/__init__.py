"""nullpose finds the best pose for a drone's antenna under jamming.

The drone carries one short dipole, whose null it can turn towards a jammer. Given ground nodes, jammers and
an airspace, nullpose finds the position and the attitude that maximise the smallest SINR over the nodes.

The public names are those of ``__init__.pyi``. Each is imported at its first use, so that the import of the
package is fast.
"""

from __future__ import annotations

import lazy_loader

from nullpose.version import __version__

__getattr__, __dir__, _names = lazy_loader.attach_stub(__name__, __file__)
__all__ = [*_names, "__version__"]
