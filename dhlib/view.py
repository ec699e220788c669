"""From where a figure is seen: a parallel projection with z up."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from dhlib.scalars import FloatArray

#: The usual azimuth and elevation of the eye in degrees: x points right and a little towards the reader.
VIEW = (-52.0, 24.0)


@dataclass(frozen=True)
class View:
    """A parallel projection from azimuth and elevation, in degrees; z is up."""

    azimuth: float = VIEW[0]
    elevation: float = VIEW[1]

    def project(self, points: Any) -> FloatArray:
        """Right, down and towards the reader, (…, 3) to (…, 3).

        Examples
        --------
        >>> View(0, 0).project([1, 2, 3])
        array([ 2., -3.,  1.])
        """
        return np.asarray(np.asarray(points, dtype=np.float64) @ self.directions.T)

    @property
    def directions(self) -> FloatArray:
        """The unit vectors right, down and towards the reader, as rows (3, 3)."""
        azimuth, elevation = np.deg2rad([self.azimuth, self.elevation])
        ca, sa, ce, se = np.cos(azimuth), np.sin(azimuth), np.cos(elevation), np.sin(elevation)
        return np.array([[-sa, ca, 0], [se * ca, se * sa, -ce], [ce * ca, ce * sa, se]])
