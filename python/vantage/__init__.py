# SPDX-License-Identifier: Apache-2.0
"""Plans terrestrial LiDAR surveys: where should a laser scanner stand?

Simulates a scanner in a 3D model by ray tracing, measures what a set of stations would capture, and searches for good
sets. Everything is in the survey frame, right-handed with Z up, in metres; angles end in `_deg`. docs/python.md has a
tour.
"""

from ._core import *
from ._core import __version__
from . import _notebook as _

__all__ = [name for name in dir() if not name.startswith("_")] + ["__version__"]
