"""The same arm in the hands of each library, called as its own documentation recommends.

Each function takes the arm as a modified chain of revolute joints without base and tool, and gives the ways in which
that library computes a pose (4×4) from joint angles. Imports stand inside: each library lives in an environment of
its own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from dhlib import Chain, Rx, Tx


@dataclass(frozen=True)
class Contender:
    """One way to compute poses.

    Parameters
    ----------
    call : str
        As one writes it.
    one : callable
        Joint vector (n,) to pose (4, 4).
    many : callable
        Joint vectors (N, n) to poses (N, 4, 4).
    loops : bool
        Whether `many` calls `one` for each: then fewer vectors are enough to know its rate.
    """

    call: str
    one: Callable[[Any], Any]
    many: Callable[[Any], Any]
    loops: bool = False


def looping(call: str, one: Callable[[Any], Any]) -> Contender:
    """A library that takes one joint vector at a time, in the loop that its user writes."""

    def many(qs: Any) -> Any:
        poses = np.empty((len(qs), 4, 4))
        for k, q in enumerate(qs):
            poses[k] = one(q)
        return poses

    return Contender(call, one, many, loops=True)


def roboticstoolbox(arm: Chain) -> Iterator[Contender]:
    """Documented: `fkine`, also for arrays of joint vectors; `ets()` turns the table into its C++ path."""
    import roboticstoolbox as rtb

    links = [rtb.RevoluteMDH(alpha=j.alpha, a=j.a, d=j.d, offset=j.offset) for j in arm.joints]
    robot = rtb.DHRobot(links)
    yield Contender("robot.fkine(q)", lambda q: robot.fkine(q).A, lambda qs: np.array(robot.fkine(qs).A))
    ets = robot.ets()
    yield Contender("robot.ets().eval(q)", lambda q: ets.eval(q), lambda qs: ets.eval(qs))


def pinocchio(arm: Chain) -> Iterator[Contender]:
    """Documented: `forwardKinematics`, then `data.oMi`; its Python interface takes one joint vector at a time."""
    import pinocchio as pin

    model = pin.Model()
    joint = 0
    for i, row in enumerate(arm.joints, 1):
        before = Rx(row.alpha) @ Tx(row.a)
        before[:3, 3] += before[:3, 2] * row.d  # d shifts along the joint's own axis
        joint = model.addJoint(joint, pin.JointModelRZ(), pin.SE3(before), f"joint{i}")
    data = model.createData()

    def one(q: Any) -> Any:
        pin.forwardKinematics(model, data, q)
        return data.oMi[joint].homogeneous

    yield looping("pin.forwardKinematics(model, data, q)", one)


def modern_robotics(arm: Chain) -> Iterator[Contender]:
    """Documented: `FKinSpace` with the screw axes in the base frame."""
    import modern_robotics as mr

    home = arm.fk(np.zeros(arm.n))
    screws = np.array([[*a.direction, *-np.cross(a.direction, a.point)] for a in arm.axes()]).T
    yield looping("FKinSpace(M, Slist, q)", lambda q: mr.FKinSpace(home, screws, q))


def pybotics(arm: Chain) -> Iterator[Contender]:
    """Documented: `Robot.from_parameters` with modified parameters, then `fk`."""
    from pybotics.robot import Robot

    robot = Robot.from_parameters(np.array([[j.alpha, j.a, j.offset, j.d] for j in arm.joints]))
    yield looping("robot.fk(q)", robot.fk)


def ikpy(arm: Chain) -> Iterator[Contender]:
    """Documented: a `Chain` of links, then `forward_kinematics`, with a value for the fixed first link."""
    from ikpy.chain import Chain as IkpyChain
    from ikpy.link import DHLink, OriginLink

    links = [
        DHLink(f"link{i}", d=j.d, a=j.a, alpha=j.alpha, theta=j.offset, convention="modified")
        for i, j in enumerate(arm.joints, 1)
    ]
    chain = IkpyChain([OriginLink(), *links], active_links_mask=[False] + [True] * arm.n)
    yield looping("chain.forward_kinematics([0, *q])", lambda q: chain.forward_kinematics([0, *q]))


def visual_kinematics(arm: Chain) -> Iterator[Contender]:
    """Documented: `RobotSerial` with rows d, a, α, θ, then `forward`, which gives a `Frame`."""
    from visual_kinematics.RobotSerial import RobotSerial

    robot = RobotSerial(np.array([[j.d, j.a, j.alpha, j.offset] for j in arm.joints]), dh_type="modified")
    yield looping("robot.forward(q)", lambda q: robot.forward(q).t_4_4)


def kinpy(arm: Chain) -> Iterator[Contender]:
    """Documented: `build_serial_chain_from_urdf`, then `forward_kinematics`, which takes arrays too."""
    import kinpy as kp

    parts = ['<robot name="arm"><link name="link0"/>']
    for i, row in enumerate(arm.joints, 1):
        before = Rx(row.alpha) @ Tx(row.a)
        xyz = before[:3, 3] + before[:3, 2] * row.d
        parts.append(
            f'<link name="link{i}"/><joint name="joint{i}" type="continuous"><parent link="link{i - 1}"/>'
            f'<child link="link{i}"/><origin xyz="{xyz[0]!r} {xyz[1]!r} {xyz[2]!r}" rpy="{row.alpha!r} 0 0"/>'
            f'<axis xyz="0 0 1"/></joint>'.replace("np.float64(", "").replace(")", "")
        )
    chain = kp.build_serial_chain_from_urdf("".join(parts) + "</robot>", f"link{arm.n}")
    yield looping("chain.forward_kinematics(q)", lambda q: chain.forward_kinematics(q).matrix())


def numba(arm: Chain) -> Iterator[Contender]:
    """No library but a limit: the columns of this very table, compiled by numba, on one core."""
    from math import cos, sin

    from numba import njit

    table = np.array([[np.cos(j.alpha), np.sin(j.alpha), j.a, j.d, j.offset] for j in arm.joints])

    @njit(error_model="numpy")
    def fill(qs: Any, out: Any) -> None:
        for k in range(len(qs)):
            r = np.eye(3)
            p = np.zeros(3)
            for i in range(len(table)):
                ca, sa, a, d, offset = table[i]
                c, s = cos(qs[k, i] + offset), sin(qs[k, i] + offset)
                for row in range(3):
                    p[row] += a * r[row, 0]
                    y, z = r[row, 1], r[row, 2]
                    r[row, 1], r[row, 2] = ca * y + sa * z, ca * z - sa * y
                    p[row] += d * r[row, 2]
                    x, y = r[row, 0], r[row, 1]
                    r[row, 0], r[row, 1] = c * x + s * y, c * y - s * x
            out[k, :3, :3] = r
            out[k, :3, 3] = p
            out[k, 3] = 0
            out[k, 3, 3] = 1

    def many(qs: Any) -> Any:
        out = np.empty((len(qs), 4, 4))
        fill(qs, out)
        return out

    yield Contender("columns, compiled by numba", lambda q: many(np.asarray(q)[None])[0], many)


def memory(arm: Chain) -> Iterator[Contender]:
    """No library but a limit: nothing but writing that many matrices."""
    template = np.eye(4)

    def many(qs: Any) -> Any:
        out = np.empty((len(qs), 4, 4))
        out[:] = template
        return out

    yield Contender("writing the matrices only", lambda q: template.copy(), many)


CONTENDERS: dict[str, Callable[[Chain], Iterator[Contender]]] = {
    "roboticstoolbox": roboticstoolbox,
    "pinocchio": pinocchio,
    "modern_robotics": modern_robotics,
    "pybotics": pybotics,
    "ikpy": ikpy,
    "visual_kinematics": visual_kinematics,
    "kinpy": kinpy,
    "numba": numba,
    "memory": memory,
}
