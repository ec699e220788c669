"""dhlib: the Denavit-Hartenberg conventions, for numbers and symbols.

Read it in the order of the book: `transforms`, `conventions`, `joints`, `forward`, `chain`, `convert`,
`symbolic`, `axes`, `normals`, `preconditions`, `placement`, `overlay`, `mechanism`, `robots`.
"""

from dhlib import robots
from dhlib.axes import Axis
from dhlib.chain import Chain
from dhlib.conventions import classic, modified
from dhlib.errors import DHError, DHWarning
from dhlib.joints import Prismatic, Revolute
from dhlib.mechanism import Sameness, mirror_image, same_mechanism
from dhlib.placement import Choice, Placement, place_frames, read_parameters
from dhlib.preconditions import FrameReport, LinkReport, check_frames
from dhlib.transforms import Rx, Ry, Rz, Tx, Ty, Tz, inverse

__version__ = "0.1.0.dev0"

__all__ = [
    "Axis",
    "Chain",
    "Choice",
    "DHError",
    "DHWarning",
    "FrameReport",
    "LinkReport",
    "Placement",
    "Prismatic",
    "Revolute",
    "Rx",
    "Ry",
    "Rz",
    "Sameness",
    "Tx",
    "Ty",
    "Tz",
    "check_frames",
    "classic",
    "inverse",
    "mirror_image",
    "modified",
    "place_frames",
    "read_parameters",
    "robots",
    "same_mechanism",
]
