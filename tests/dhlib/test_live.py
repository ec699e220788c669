"""Live figures as cells use them: with a page that plays the browser's part, and without one."""

import json
import math

import numpy as np
import pytest
import sympy

from dhlib import Chain, DHError, Prismatic, Revolute, live, robots
from dhlib.export import chain_data, figure_data
from dhlib.live import live_figure

ARM = robots.quickshot()


@pytest.fixture
def page(monkeypatch):
    """A page with two figures; what it is sent is kept as the browser gets it."""
    states = {
        "arm": {"kind": "robot", "q": [0.0] * 4, "chain": chain_data(ARM)},
        "link": {
            "kind": "link", "convention": "classic", "theta": 30, "d": 0.5, "a": 1, "alpha": -90, "reach": 2
        },
    }  # fmt: skip
    page = live.Page(json.loads(json.dumps(states)), lambda name, entries: sent.append((name, json.dumps(entries))))
    sent = page.sent = []
    monkeypatch.setattr(live, "page", page)
    return page


def test_the_joints_are_those_of_the_page(page):
    page.states["arm"]["q"] = [0.1, 0.2, 0.3, 0.4]
    figure = live_figure("arm", ARM, [1, 1, 1, 1])
    assert figure.q.tolist() == [0.1, 0.2, 0.3, 0.4]
    assert figure.chain is ARM
    assert page.sent == []


def test_another_chain_is_shown_with_all_that_the_figure_needs(page):
    other = robots.puma560()
    figure = live_figure("arm", ARM).show(other, [0.5, -0.5, 0.5, 0.1, 0.1, 0.1])
    ((name, entries),) = page.sent
    assert name == "arm"
    assert json.loads(entries)["figure"] == json.loads(json.dumps(figure_data(other)))
    assert figure.chain is other
    assert np.allclose(figure.chain.fk(figure.q), other.fk([0.5, -0.5, 0.5, 0.1, 0.1, 0.1]))


def test_moving_sends_the_joints_alone(page):
    live_figure("arm", ARM).move([0.5, 0, 0, 0])
    assert page.sent == [("arm", '{"q": [0.5, 0.0, 0.0, 0.0]}')]


def test_a_figure_that_was_reset_tells_what_it_shows_now(page):
    figure = live_figure("arm", ARM).show(robots.puma560())
    page.states["arm"].update(chain=chain_data(robots.stanford()), q=[0.0] * 6)
    assert figure.chain == robots.stanford()


def test_joints_stay_where_the_next_chain_can_have_them():
    figure = live_figure("arm", robots.planar(2), [0.3, 0.4])
    assert figure.show(Chain([Revolute(a=1), Revolute(a=2, limits=(-1, 1))], "classic")).q.tolist() == [0.3, 0.4]
    assert figure.show(Chain([Revolute(a=1), Revolute(a=2, limits=(-0.1, 0.1))], "classic")).q.tolist() == [0, 0]
    assert figure.show(robots.planar(3)).q.tolist() == [0, 0, 0]


@pytest.mark.parametrize("convention", ["classic", "modified"])
@pytest.mark.parametrize(
    "joint", [Revolute(d=0.25, a=1.5, alpha=0.5, offset=0.75), Prismatic(theta=-1, a=0.5, alpha=2, offset=1, sign=-1)]
)
def test_a_link_comes_back_as_it_was_shown(page, convention, joint):
    chain = Chain([joint], convention)
    figure = live_figure("link", chain).show(chain, [0.5])
    state = page.states["link"]
    theta, d = joint.at(0.5)
    assert math.radians(state["theta"]) == pytest.approx(theta)
    assert state["d"] == d
    assert figure.q == pytest.approx([0.5])
    assert np.allclose(figure.chain.A(1, figure.q), chain.A(1, [0.5]))
    state["a"], state["convention"] = -2, "modified"
    assert (figure.chain.joints[0].a, figure.chain.convention) == (-2, "modified")


@pytest.mark.parametrize(
    ("mistake", "words"),
    [
        (lambda: live_figure("leg", ARM), r"no live figure called 'leg'. What can be given is: 'arm', 'link'"),
        (lambda: live_figure("link", ARM).show(ARM), "shows one link, and the chain has 4 joints"),
        (lambda: live_figure("link", ARM).show(Chain([Revolute(d=3)], "classic")), "d is 3, beyond .* 2 to either"),
        (lambda: live_figure("arm", ARM).move([1, 2]), "q"),
        (lambda: live_figure("arm", ARM).move(np.zeros((2, 4))), r"shape \(2, 4\)"),
        (lambda: live_figure("arm", ARM).move([np.nan, 0, 0, 0]), "q"),
        (lambda: live_figure("arm", ARM).move([0, 0, 99, 0]), "q3 is 99, beyond the limits of joint 3"),
    ],
)
@pytest.mark.filterwarnings("ignore::dhlib.DHWarning")
def test_mistakes_are_told_and_change_nothing(page, mistake, words):
    if "limits" in words:
        page.states["arm"]["chain"] = chain_data(
            Chain([joint.replace(limits=(-1.0, 1.0)) for joint in ARM.joints], "classic")
        )
    with pytest.raises(DHError, match=words):
        mistake()
    assert page.sent == []


@pytest.mark.parametrize(
    ("use", "words"),
    [
        (lambda arm: live_figure("arm", arm), "a figure cannot show. Give them values first."),
        (chain_data, "cannot be exported. Give them values first."),
    ],
)
def test_an_arm_without_numbers_cannot_be_shown_or_exported(use, words):
    with pytest.raises(DHError, match=f"this chain holds symbols, which {words}"):
        use(Chain([Revolute(a=sympy.Symbol("a1"))], "classic"))


def test_a_page_without_figures_says_so(monkeypatch):
    monkeypatch.setattr(live, "page", live.Page({}, lambda *_: None))
    with pytest.raises(DHError, match="this page has no live figure, so none is called 'arm'"):
        live_figure("arm", ARM)


def test_without_a_page_it_draws():
    figure = live_figure("arm", ARM).move([0.1, 0.2, 0.3, 0.4])
    assert "<svg" in figure._repr_html_()
    assert figure._repr_html_() != live_figure("arm", ARM)._repr_html_()
    assert "<svg" in live_figure("link", robots.planar(1))._repr_html_()
    q = figure.q
    q[0] = 5
    assert figure.q[0] == 0.1, "what is given away is a copy"
