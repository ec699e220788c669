"""Real arms: their DH tables, with the source of every number and what to beware of.

Each function returns a new :class:`dhlib.Chain`. A table that its source gives in the other convention is
converted: same q, same T.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from dhlib.chain import Chain
from dhlib.conventions import read_convention
from dhlib.errors import DHError
from dhlib.joints import Joint, Limits, Prismatic, Revolute
from dhlib.transforms import Tz

__all__ = [
    "cobra600",
    "iiwa14",
    "irb140",
    "pa10_6c",
    "pa10_7c",
    "panda",
    "planar",
    "puma560",
    "quickshot",
    "stanford",
    "ur5",
]

Row = tuple[float, float, float]
"""a, α in degrees, d."""


def _revolute(
    rows: Sequence[Row], offsets: Sequence[float] | None = None, limits: Sequence[Limits] | None = None
) -> list[Joint]:
    """Revolute joints from rows (a, α, d), offsets and limits; angles in degrees."""
    return [
        Revolute(
            d=d,
            a=a,
            alpha=math.radians(alpha),
            offset=math.radians(offsets[i]) if offsets else 0.0,
            limits=_radians(limits[i]) if limits else None,
        )
        for i, (a, alpha, d) in enumerate(rows)
    ]


def _radians(limits: Limits) -> Limits:
    return math.radians(limits[0]), math.radians(limits[1])


def _symmetric(*degrees: float) -> list[Limits]:
    return [(-limit, limit) for limit in degrees]


def _in(convention: str, chain: Chain) -> Chain:
    """The chain in the convention asked for."""
    return chain.to_classic() if read_convention(convention) == "classic" else chain.to_modified()


def _choose(name: str, value: str, table: dict[str, object]) -> None:
    if value not in table:
        known = ", ".join(repr(key) for key in table)
        raise DHError(f"{name}={value!r} is unknown; it should be one of {known}.")


def planar(n: int = 2, convention: str = "classic") -> Chain:
    """A planar arm: n parallel revolute joints, every link of length 1.

    Parameters
    ----------
    n : int
        Number of joints, at least 1.
    convention : {"classic", "modified"}

    Notes
    -----
    In the modified table the last length stands in the tool. A planar arm cannot tell α, d and base apart: it
    is good for first steps and bad for finding mistakes.

    Examples
    --------
    >>> float(planar(3).fk([0, 0, 0])[0, 3])
    3.0
    """
    if not isinstance(n, int) or isinstance(n, bool) or n < 1:
        raise DHError(f"planar({n!r}): the number of joints should be a whole number, 1 or more.")
    return _in(convention, Chain(_revolute([(1, 0, 0)] * n), "classic", name=f"Planar {n}R"))


def quickshot(convention: str = "classic") -> Chain:
    """The QuickShot arm (Spectravideo SVI-2000 Robotarm, 1985), lengths in millimetres.

    Four motions (base, shoulder, elbow, wrist rotation) and a gripper, driven by five motors without position
    sensors.

    Parameters
    ----------
    convention : {"classic", "modified"}

    Notes
    -----
    L. Einig and J. Zhang, *Introduction to Robotics*, lecture 2, Universität Hamburg, 2018. No other public
    table is known.

    Examples
    --------
    >>> quickshot().fk([0, 0, 0, 0])[:3, 3]
    array([180.,  28., 350.])
    """
    rows = [(20, -90, 100), (160, 0, 0), (0, 90, 28), (0, 0, 250)]
    return _in(convention, Chain(_revolute(rows), "classic", name="Quickshot", unit="mm"))


#: PUMA 560 by source: the convention in which the source gives it, rows (a, α, d), and how many degrees its
#: joint zeros differ from Corke's: q of the source = q of Corke + shift.
_PUMA: dict[str, tuple[str, list[Row], tuple[float, ...]]] = {
    "craig": (
        "modified",
        [(0, 0, 0), (0, -90, 0), (0.4318, 0, 0.15005), (0.0203, -90, 0.4318), (0, 90, 0), (0, -90, 0)],
        (180, 180, 0, 0, 0, 0),
    ),
    "corke": (
        "classic",
        [(0, 90, 0), (0.4318, 0, 0), (0.0203, -90, 0.15005), (0, 90, 0.4318), (0, -90, 0), (0, 0, 0)],
        (0, 0, 0, 0, 0, 0),
    ),
    "akb": (
        "modified",
        [(0, 0, 0), (0, -90, 0.2435), (0.4318, 0, -0.0934), (-0.0203, 90, 0.4331), (0, -90, 0), (0, 90, 0)],
        (180, 180, 180, 0, 0, -180),
    ),
    "fgl": (
        "classic",
        [
            (0, -90, 0),
            (0.4318, 0, 0.14909),
            (-0.02032, 90, 0),
            (0, -90, 0.43307),
            (0, 90, 0),
            (0, 0, 0.05625),
        ],
        (180, 180, 180, 0, 0, -180),
    ),
}
_PUMA_LIMITS = [
    (-160.0, 160.0),
    (-45.0, 225.0),
    (-225.0, 45.0),
    (-110.0, 170.0),
    (-100.0, 100.0),
    (-266.0, 266.0),
]


def puma560(convention: str = "modified", source: str = "craig") -> Chain:
    """The Unimation PUMA 560, lengths in metres.

    Parameters
    ----------
    convention : {"classic", "modified"}
    source : {"craig", "corke", "akb", "fgl"}
        Whose table: J. J. Craig (modified); P. Corke (classic); B. Armstrong, O. Khatib and J. Burdick
        (modified); K. S. Fu, R. C. Gonzalez and C. S. G. Lee (classic).

    Notes
    -----
    The four tables have other joint zeros, and the lengths differ a little between the sources. The limits are
    those of Corke's Robotics Toolbox for MATLAB (mdl_puma560.m), moved to the zeros of the source. Corke's
    toolbox for Python stands the arm on d_1 = 0.67183 m; here frame 0 lies in the shoulder, as in the older table.

    Examples
    --------
    >>> puma560().fk([0, 0, 0, 0, 0, 0])[:3, 3]
    array([ 0.4521 ,  0.15005, -0.4318 ])
    """
    _choose("source", source, dict(_PUMA))
    own, rows, shift = _PUMA[source]
    limits = [_nearest_turn(low + by, high + by) for (low, high), by in zip(_PUMA_LIMITS, shift, strict=True)]
    return _in(convention, Chain(_revolute(rows, limits=limits), own, name=f"PUMA 560 ({source})"))


def _nearest_turn(low: float, high: float) -> Limits:
    """The same interval of angles, whole turns away, with its middle nearest to 0."""
    turns = math.ceil((low + high) / 720 - 0.5)
    return low - 360 * turns, high - 360 * turns


#: Mitsubishi PA10 by set of lengths: base to S2 (b), upper arm (l1), forearm (l2), flange (f).
_PA10 = {
    "A": (0.317, 0.450, 0.480, 0.070),
    "B": (0.315, 0.450, 0.500, 0.080),
    "B2": (0.315, 0.450, 0.500, 0.085),
}


def pa10_7c(convention: str = "classic", lengths: str = "A") -> Chain:
    """The Mitsubishi PA10-7C, seven joints, lengths in metres.

    Parameters
    ----------
    convention : {"classic", "modified"}
    lengths : {"A", "B", "B2"}
        Incompatible sets are in circulation, and no manual of the manufacturer could be read. A: 0.317, 0.450,
        0.480, 0.070 (mlogoth/PA10; jmainpri/libmove3d; siconos HuMAns). B: 0.315, 0.450, 0.500, 0.080
        (RobospectEU; ARTE; Magiks; robotblockset). B2: as B with a flange of 0.085 (OpenRAVE; pa10_moveit).

    Notes
    -----
    At q = 0 the arm stands straight up. Limits of S2 and W2 differ between sources (91° or 94°; 255° or none).

    Examples
    --------
    >>> round(float(pa10_7c().fk([0] * 7)[2, 3]), 3)
    1.317
    """
    _choose("lengths", lengths, dict(_PA10))
    b, l1, l2, f = _PA10[lengths]
    rows = [(0, -90, b), (0, 90, 0), (0, -90, l1), (0, 90, 0), (0, -90, l2), (0, 90, 0), (0, 0, f)]
    limits = _symmetric(177, 91, 174, 137, 255, 165, 255)
    return _in(convention, Chain(_revolute(rows, limits=limits), "classic", name=f"PA10-7C (lengths {lengths})"))


def pa10_6c(convention: str = "classic", lengths: str = "A") -> Chain:
    """The Mitsubishi PA10-6C: the 7C without S3, lengths in metres.

    Parameters
    ----------
    convention : {"classic", "modified"}
    lengths : {"A", "B", "B2"}
        As for :func:`pa10_7c`. A drawing file for the lecture group's own PA10-6C has 70.6 mm from axis 5 to the
        tool plate (TAMS-Group/tams_openscad), which speaks for set A.

    Notes
    -----
    Its pose at (q1, …, q6) is the 7C's at (q1, q2, 0, q3, …, q6).

    Examples
    --------
    >>> round(float(pa10_6c().fk([0] * 6)[2, 3]), 3)
    1.317
    """
    _choose("lengths", lengths, dict(_PA10))
    b, l1, l2, f = _PA10[lengths]
    rows = [(0, -90, b), (l1, 0, 0), (0, 90, 0), (0, -90, l2), (0, 90, 0), (0, 0, f)]
    limits = _symmetric(177, 91, 137, 255, 165, 360)
    joints = _revolute(rows, offsets=(0, -90, 90, 0, 0, 0), limits=limits)
    return _in(convention, Chain(joints, "classic", name=f"PA10-6C (lengths {lengths})"))


def stanford(convention: str = "classic") -> Chain:
    """The Stanford arm (RRPRRR), lengths in metres.

    Parameters
    ----------
    convention : {"classic", "modified"}

    Notes
    -----
    Corke's Robotics Toolbox for MATLAB, mdl_stanford.m. The toolbox for Python has a = 0.0203 on the prismatic
    link and no tool.

    Examples
    --------
    >>> stanford().kinds
    'RRPRRR'
    """
    joints: list[Joint] = [
        Revolute(d=0.412, alpha=-math.pi / 2),
        Revolute(d=0.154, alpha=math.pi / 2),
        Prismatic(theta=-math.pi / 2),
        Revolute(alpha=-math.pi / 2),
        Revolute(alpha=math.pi / 2),
        Revolute(d=0.263),
    ]
    return _in(convention, Chain(joints, "classic", name="Stanford arm"))


def cobra600(convention: str = "classic") -> Chain:
    """The Adept Cobra 600, a SCARA (RRPR), lengths in metres.

    Parameters
    ----------
    convention : {"classic", "modified"}

    Notes
    -----
    Corke's Robotics Toolbox for MATLAB, mdl_cobra600.m. α_2 = 180° turns the last two axes downwards.

    Examples
    --------
    >>> cobra600().fk([0, 0, 0.1, 0])[:3, 3]
    array([0.6  , 0.   , 0.287])
    """
    joints: list[Joint] = [
        Revolute(d=0.387, a=0.325, limits=_radians((-50, 50))),
        Revolute(a=0.275, alpha=math.pi, limits=_radians((-88, 88))),
        Prismatic(limits=(0, 0.210)),
        Revolute(),
    ]
    return _in(convention, Chain(joints, "classic", name="Adept Cobra 600"))


def ur5(convention: str = "classic") -> Chain:
    """The Universal Robots UR5, lengths in metres.

    Parameters
    ----------
    convention : {"classic", "modified"}

    Notes
    -----
    ros-industrial/universal_robot, default_kinematics.yaml of the UR5. Beware of d_1 = 0.089459, a slip that
    circulates.

    Examples
    --------
    >>> ur5().joints[1]
    Revolute(a=-0.425)
    """
    rows = [
        (0, 90, 0.089159),
        (-0.425, 0, 0),
        (-0.39225, 0, 0),
        (0, 90, 0.10915),
        (0, -90, 0.09465),
        (0, 0, 0.0823),
    ]
    return _in(convention, Chain(_revolute(rows), "classic", name="UR5"))


def panda(convention: str = "modified") -> Chain:
    """The Franka Emika Panda with its flange, seven joints, lengths in metres.

    Parameters
    ----------
    convention : {"classic", "modified"}

    Notes
    -----
    frankaemika/docs, control_parameters.rst: the manufacturer's own table is modified. The flange, d = 0.107,
    stands in the tool.

    Examples
    --------
    >>> float(panda().tool[2, 3])
    0.107
    """
    rows = [
        (0, 0, 0.333),
        (0, -90, 0),
        (0, 90, 0.316),
        (0.0825, 90, 0),
        (-0.0825, -90, 0.384),
        (0, 90, 0),
        (0.088, 90, 0),
    ]
    return _in(convention, Chain(_revolute(rows), "modified", tool=Tz(0.107), name="Franka Emika Panda"))


def iiwa14(convention: str = "classic") -> Chain:
    """The KUKA LBR iiwa 14 R820, seven joints, lengths in metres.

    Parameters
    ----------
    convention : {"classic", "modified"}

    Notes
    -----
    Modi1987/KST-Kuka-Sunrise-Toolbox.

    Examples
    --------
    >>> round(float(iiwa14().fk([0] * 7)[2, 3]), 3)
    1.306
    """
    rows = [(0, -90, 0.36), (0, 90, 0), (0, 90, 0.42), (0, -90, 0), (0, -90, 0.40), (0, 90, 0), (0, 0, 0.126)]
    return _in(convention, Chain(_revolute(rows), "classic", name="KUKA LBR iiwa 14"))


def irb140(convention: str = "classic") -> Chain:
    """The ABB IRB 140, lengths in metres.

    Parameters
    ----------
    convention : {"classic", "modified"}

    Notes
    -----
    Corke's Robotics Toolbox for Python, models/DH/IRB140.py.

    Examples
    --------
    >>> irb140().joints[0]
    Revolute(d=0.352, a=0.07, alpha=-90°)
    """
    rows = [(0.07, -90, 0.352), (0.36, 0, 0), (0, -90, 0), (0, 90, 0.38), (0, -90, 0), (0, 0, 0.065)]
    return _in(convention, Chain(_revolute(rows), "classic", name="ABB IRB 140"))
