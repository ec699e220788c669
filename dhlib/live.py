"""Figures to move, shared with code: what the reader has set is read, and a chain is shown.

In a page of the book a live figure and the cells around it have one state. The same code runs in a notebook and in a
script: there it keeps the state by itself, and shows it as a drawing.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from dhlib.chain import Chain
from dhlib.errors import DHError
from dhlib.export import figure_data, read_chain
from dhlib.scalars import FloatArray

State = dict[str, Any]
HALF_DEGREE = math.radians(0.5)


class Page:
    """What a page has of figures: the state of each by its name, and where to send what one is to show.

    Parameters
    ----------
    states : mapping
        For each figure its ``kind``. A ``robot`` has ``q`` and, as `chain_data` writes it, its ``chain``; a ``link``
        has ``convention``, ``theta`` and ``alpha`` in degrees, ``d`` and ``a``, and the ``reach`` of its lengths.
    send : callable
        Takes the name of a figure, and the entries of its state that change.
    """

    def __init__(self, states: Mapping[str, State], send: Callable[[str, State], None]) -> None:
        self.states = {name: dict(state) for name, state in states.items()}
        self._send = send

    def state(self, name: str) -> State:
        """Return the state of a figure.

        Raises
        ------
        DHError
            If the page has no such figure; the message names those that it has.
        """
        if name in self.states:
            return self.states[name]
        if not self.states:
            raise DHError(f"this page has no live figure, so none is called {name!r}.")
        names = ", ".join(repr(one) for one in self.states)
        raise DHError(f"this page has no live figure called {name!r}. What can be given is: {names}.")

    def change(self, name: str, entries: State) -> None:
        """Change a figure, here and in the page."""
        self.state(name).update(entries)
        self._send(name, entries)


#: The page in which this Python runs; its kernel sets it.
page: Page | None = None


class LiveFigure:
    """A live figure of the page, or what stands for it elsewhere; see :func:`live_figure`.

    Its value at the end of a cell is a drawing of what it shows.
    """

    def __init__(self, name: str, chain: Chain, q: Any = None) -> None:
        self.name = name
        self._chain = chain
        self._q = read_joints(chain, [0.0] * chain.n if q is None else q)
        if page is not None:
            page.state(name)

    @property
    def chain(self) -> Chain:
        """The chain that the figure shows; of one joint, if it is a figure of one link."""
        if page is None:
            return self._chain
        state = page.state(self.name)
        if state["kind"] == "link":
            return _chain_of_link(self._chain, state)
        shown = read_chain(state["chain"])
        return self._chain if shown == self._chain.to_classic() else shown

    @property
    def q(self) -> FloatArray:
        """The joint values as they are set now, (n,): in radians, and lengths in the unit of the chain."""
        if page is None:
            return self._q.copy()
        state = page.state(self.name)
        if state["kind"] == "robot":
            return np.array(state["q"], dtype=np.float64)
        (joint,) = self.chain.joints
        value = math.radians(state["theta"]) if joint.kind == "R" else state["d"]
        return np.array([joint.sign * (value - float(joint.offset))])

    def move(self, q: Any) -> LiveFigure:
        """Set the joints.

        Parameters
        ----------
        q : array_like (n,)

        Returns
        -------
        LiveFigure
            Itself, so that a cell can end with it.

        Raises
        ------
        DHError
            If q does not fit the chain, or is beyond a limit of a joint.
        """
        return self.show(self.chain, q)

    def show(self, chain: Chain, q: Any = None) -> LiveFigure:
        """Show another chain.

        Parameters
        ----------
        chain : Chain
            With numbers throughout.
        q : array_like (n,), optional
            If left out, the joints stay where they are, or stand at 0 where the chain cannot be so.

        Returns
        -------
        LiveFigure
            Itself.

        Raises
        ------
        DHError
            If the chain holds symbols, q does not fit it, or the figure shows one link and the chain has more.
        """
        joints = self._kept(chain) if q is None else read_joints(chain, q)
        if q is not None and (words := beyond_limits(chain, joints)):
            raise DHError(words)
        if page is not None:
            state = page.state(self.name)
            write = _link_entries if state["kind"] == "link" else _robot_entries
            entries = write(chain, joints, state)
            page.change(self.name, entries)
        self._chain, self._q = chain, joints
        return self

    def _kept(self, chain: Chain) -> FloatArray:
        """The joints as they are, if another chain can have them; else its zero."""
        if chain.kinds == self.chain.kinds and not beyond_limits(chain, self.q):
            return self.q
        return read_joints(chain, [0.0] * chain.n)

    def __repr__(self) -> str:
        return f"<live figure {self.name!r}: {self.chain.name or f'{self.chain.n} joints'}>"

    def _repr_html_(self) -> str:
        from dhlib.sketch import link, sketch

        only = self.chain.n == 1
        return (link(self.chain, 1, self.q) if only else sketch(self.chain, self.q)).svg()


def live_figure(name: str, chain: Chain, q: Any = None) -> LiveFigure:
    """Take hold of a live figure of the page, to read it and to show something in it.

    Parameters
    ----------
    name : str
        Of the figure, as the page gives it.
    chain : Chain
        What the figure stands for where there is no page; in a page the figure stays as it is.
    q : array_like (n,), optional
        Where the joints are where there is no page; 0 if left out.

    Returns
    -------
    LiveFigure

    Raises
    ------
    DHError
        If the page has no such figure, or q does not fit the chain.

    Examples
    --------
    >>> from dhlib import robots
    >>> figure = live_figure("arm", robots.planar(2))
    >>> figure.q
    array([0., 0.])
    >>> figure.move([0.5, -0.25]).q
    array([ 0.5 , -0.25])
    >>> figure.show(robots.planar(3))
    <live figure 'arm': Planar 3R>
    >>> figure.q
    array([0., 0., 0.])
    """
    return LiveFigure(name, chain, q)


def read_joints(chain: Chain, q: Any) -> FloatArray:
    """Read one joint vector of a chain.

    Parameters
    ----------
    chain : Chain
    q : array_like (n,)

    Returns
    -------
    ndarray (n,)

    Raises
    ------
    DHError
        If q does not fit the chain, or the chain holds symbols.

    Examples
    --------
    >>> from dhlib import robots
    >>> read_joints(robots.quickshot(), (0, 1, 0, 0))
    array([0., 1., 0., 0.])
    """
    if chain.is_symbolic:
        raise DHError("this chain holds symbols, which a figure cannot show. Give them values first.")
    chain.fk(q)  # says what is wrong with q
    joints = np.array(q, dtype=np.float64)
    if joints.shape != (chain.n,):
        raise DHError(f"q has the shape {joints.shape}; a figure shows one pose, of {chain.n} joint values.")
    return joints


def beyond_limits(chain: Chain, q: FloatArray) -> str:
    """Say which joint is beyond its limits, and what they are; half a degree is let pass for what was rounded.

    Parameters
    ----------
    chain : Chain
    q : ndarray (n,)

    Returns
    -------
    str
        Empty if none is.

    Examples
    --------
    >>> from dhlib import Revolute
    >>> beyond_limits(Chain([Revolute(a=1, limits=(-1, 1))], "classic"), np.array([3.0]))
    'q1 is 3, beyond the limits of joint 1: -1 to 1.'
    """
    for i, (value, joint) in enumerate(zip(q, chain.joints, strict=True), 1):
        low, high = joint.limits or (-math.inf, math.inf)
        slack = HALF_DEGREE if joint.kind == "R" else 0.0
        if not low - slack <= value <= high + slack:
            return f"q{i} is {value:.5g}, beyond the limits of joint {i}: {low:.5g} to {high:.5g}."
    return ""


def _robot_entries(chain: Chain, q: FloatArray, state: State) -> State:
    if read_chain(state["chain"]) == chain.to_classic():
        return {"q": q.tolist()}
    data = figure_data(chain)
    return {"q": q.tolist(), "chain": data["classic"], "figure": data}


def _link_entries(chain: Chain, q: FloatArray, state: State) -> State:
    if chain.n != 1:
        raise DHError(
            f"this figure shows one link, and the chain has {chain.n} joints. "
            "Give a chain of one of its joints: Chain([arm.joints[0]], arm.convention)."
        )
    (joint,) = chain.joints
    theta, d = (float(value) for value in joint.at(float(q[0])))
    lengths = {"d": d, "a": float(joint.a)}
    for name, value in lengths.items():
        if abs(value) > state["reach"]:
            raise DHError(
                f"{name} is {value:.6g}, beyond what this figure can show: {state['reach']:g} to either side."
            )
    angles = {
        name: math.degrees(math.remainder(value, math.tau))
        for name, value in {"theta": theta, "alpha": float(joint.alpha)}.items()
    }
    return {"convention": chain.convention} | lengths | angles


def _chain_of_link(given: Chain, state: State) -> Chain:
    """The chain of one joint that a figure of a link shows, with the offset of the one it was given."""
    joint = given.joints[0]
    theta, alpha = math.radians(state["theta"]), math.radians(state["alpha"])
    constant = {"d": state["d"]} if joint.kind == "R" else {"theta": theta}
    changed = joint.replace(a=state["a"], alpha=alpha, **constant)
    return Chain([changed], state["convention"], name=given.name, unit=given.unit)
