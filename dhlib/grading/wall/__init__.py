"""The wall: strangers' code runs behind it, and only plain answers come back.

Use one `Sandbox` for each worker; it is not shared between threads:

    with Sandbox(Limits()) as sandbox:
        outcome = sandbox.run(cells, requests)
"""

from dhlib.grading.wall.limits import Limits, Outcome
from dhlib.grading.wall.sandbox import Sandbox

__all__ = ["Limits", "Outcome", "Sandbox"]
