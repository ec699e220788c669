"""Every public name says what it takes, gives and refuses, with an example that runs."""

import importlib
import inspect
import pkgutil

import pytest

import dhlib

#: The order of the book; what a learner or a chapter imports from these is public.
MODULES = sorted(
    module.name
    for module in pkgutil.iter_modules(dhlib.__path__, "dhlib.")
    if not module.ispkg and module.name.rpartition(".")[2] not in {"cli"}
)


def public_callables(module):
    """Functions and classes that a module defines, and the methods of these classes."""
    for name, thing in vars(module).items():
        if name.startswith("_") or getattr(thing, "__module__", None) != module.__name__:
            continue
        if inspect.isfunction(thing):
            yield f"{module.__name__}.{name}", thing
        elif inspect.isclass(thing):
            yield f"{module.__name__}.{name}", thing
            for method, function in vars(thing).items():
                if not method.startswith("_") and inspect.isfunction(function):
                    yield f"{module.__name__}.{name}.{method}", function


EVERYTHING = dict(pair for name in MODULES for pair in public_callables(importlib.import_module(name)))
EXPORTED = {name: getattr(dhlib, name) for name in dhlib.__all__ if name != "robots"} | {
    f"robots.{name}": getattr(dhlib.robots, name) for name in dhlib.robots.__all__
}
FUNCTIONS = {name: thing for name, thing in EXPORTED.items() if inspect.isfunction(thing)}
#: What a user makes with its own hands; reports and verdicts are made by the library.
MADE_BY_USERS = {"Axis": dhlib.Axis, "Chain": dhlib.Chain, "Prismatic": dhlib.Prismatic, "Revolute": dhlib.Revolute}


@pytest.mark.parametrize("name", EVERYTHING)
def test_there_is_a_docstring(name):
    doc = inspect.getdoc(EVERYTHING[name])
    assert doc
    assert doc.splitlines()[0].rstrip().endswith((".", ":", "?", "…"))


@pytest.mark.parametrize("name", FUNCTIONS | MADE_BY_USERS)
def test_what_is_exported_has_an_example(name):
    assert ">>>" in inspect.getdoc(EXPORTED[name])


@pytest.mark.parametrize("name", FUNCTIONS | MADE_BY_USERS)
def test_what_is_exported_says_what_it_takes(name):
    thing = EXPORTED[name]
    doc = inspect.getdoc(thing)
    if "parameters as for" in doc:
        return
    for parameter in inspect.signature(thing).parameters.values():
        if parameter.kind is not parameter.VAR_KEYWORD:
            assert parameter.name in doc, f"{name} does not say what {parameter.name} is"


@pytest.mark.parametrize("name", FUNCTIONS)
def test_what_is_exported_says_what_it_gives(name):
    doc = inspect.getdoc(FUNCTIONS[name])
    if name.startswith("robots.") or "parameters as for" in doc:
        return  # every robot gives a Chain, as the module says
    assert "Returns" in doc, f"{name} does not say what it returns"
