from xml.etree import ElementTree

import numpy as np
import pytest
import sympy
from arms import EVERY_ROBOT

from dhlib import Chain, Prismatic, Revolute, robots


@pytest.mark.parametrize("name", EVERY_ROBOT)
def test_every_form_shows_every_row(name):
    chain = EVERY_ROBOT[name]
    assert len(repr(chain).splitlines()) == chain.n + 2
    table = ElementTree.fromstring(chain._repr_html_())
    assert len(table.findall("./tbody/tr")) == chain.n
    assert len(table.findall("./thead/tr/th")) == 5
    assert chain._repr_latex_().count(r"\\") == chain.n
    for shown in (repr(chain), chain._repr_html_()):
        assert "e-1" not in shown
        assert chain.convention in shown


def test_columns_stand_in_the_order_of_the_operations():
    assert "θ_i | d_i | a_i |  α_i" in repr(robots.quickshot())
    assert "α_{i-1} | a_{i-1} | θ_i | d_i" in repr(robots.quickshot("modified"))


def test_the_variable_shows_its_offset_and_sign():
    arm = Chain(
        [Revolute(offset=-np.pi / 2, sign=-1), Prismatic(offset=0.5), Revolute(a=sympy.Symbol("a3"))], "classic"
    )
    shown = repr(arm)
    assert "-q1 - 90°" in shown
    assert "q2 + 0.5" in shown
    assert "a3" in shown


def test_a_twist_without_a_value_is_shown_as_its_symbol():
    twist = sympy.Symbol("alpha1")
    arm = Chain([Revolute(alpha=twist), Revolute(alpha=twist / 2)], "classic")
    assert [line.split("|")[-1].strip() for line in repr(arm).splitlines()[2:]] == ["alpha1", "alpha1/2"]
    assert "<td>alpha1/2</td>" in arm._repr_html_()


def test_a_name_cannot_smuggle_markup():
    arm = Chain([Revolute()], "classic", name="<script>")
    assert "<script>" not in arm._repr_html_()


def test_joints_show_what_is_not_zero():
    assert repr(Revolute(d=1, offset=np.pi, sign=-1)) == "Revolute(d=1, offset=180°, sign=-1)"
    assert repr(Prismatic()) == "Prismatic()"
