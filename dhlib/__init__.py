"""dhlib: the Denavit-Hartenberg conventions, for numbers and symbols.

Read it in the order of the book: `transforms`, `conventions`, `joints`, `forward`, `chain`, `convert`,
`symbolic`, `axes`, `placement`, `mechanism`, `robots`.
"""

from dhlib import robots
from dhlib.axes import Axis
from dhlib.chain import Chain
from dhlib.conventions import classic, modified
from dhlib.errors import DHError, DHWarning
from dhlib.joints import Prismatic, Revolute
from dhlib.transforms import Rx, Ry, Rz, Tx, Ty, Tz, inverse

__version__ = "0.1.0.dev0"

__all__ = [
    "Axis",
    "Chain",
    "DHError",
    "DHWarning",
    "Prismatic",
    "Revolute",
    "Rx",
    "Ry",
    "Rz",
    "Tx",
    "Ty",
    "Tz",
    "classic",
    "inverse",
    "modified",
    "robots",
]
