"""Execute chapters side by side on the cores, while Sphinx reads other pages.

Each chapter runs in a kernel of its own, so a thread has only to wait for it. Pages without code are read first, and
then each chapter as soon as its outputs are in the cache that MyST-NB reads from. A chapter that fails is left to
MyST-NB: it executes the chapter again and says what is wrong.
"""

from __future__ import annotations

import math
import os
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

from jupyter_cache import get_cache
from jupyter_cache.base import CacheBundleIn
from jupyter_cache.executors.utils import ExecutionResult, single_nb_execution
from myst_nb.core.config import NbParserConfig
from myst_nb.core.read import create_nb_reader
from sphinx.util import logging

if TYPE_CHECKING:
    from nbformat import NotebookNode
    from sphinx.application import Sphinx
    from sphinx.environment import BuildEnvironment

logger = logging.getLogger(__name__)


def cores() -> int:
    """Return the number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def notebook_of(env: BuildEnvironment, docname: str) -> NotebookNode | None:
    """Return the notebook of a page, as MyST-NB reads it; None for a page without code."""
    path = env.doc2path(docname)
    reader = create_nb_reader(path, env.myst_config, env.mystnb_config, Path(path).read_text("utf-8"))  # type: ignore[attr-defined]
    return reader.read(Path(path).read_text("utf-8")) if reader else None


def is_excluded(path: Path, config: NbParserConfig) -> bool:
    """Say whether a page is one of those that are never executed."""
    return any(PurePosixPath(path.as_posix()).match(pattern) for pattern in config.execution_excludepatterns)


def begin(app: Sphinx, env: BuildEnvironment, docnames: list[str]) -> None:
    """Start those of the pages to be read whose outputs are not known, longest text first, and read them last."""
    config: NbParserConfig = env.mystnb_config  # type: ignore[attr-defined]
    app.executing, app.executors = {}, None  # type: ignore[attr-defined]
    if config.execution_mode != "cache":
        return
    cache = get_cache(config.execution_cache_path)
    waiting: dict[str, tuple[Path, NotebookNode]] = {}
    for docname in docnames:
        path = Path(env.doc2path(docname))
        notebook = None if is_excluded(path, config) else notebook_of(env, docname)
        if notebook is not None:
            try:
                cache.match_cache_notebook(notebook)
            except KeyError:
                waiting[docname] = (path, notebook)
    docnames.sort(key=lambda docname: -waiting[docname][0].stat().st_size if docname in waiting else -math.inf)
    app.executors = ThreadPoolExecutor(max(2, cores()))  # type: ignore[attr-defined]
    for docname in docnames:
        if docname in waiting:
            path, notebook = waiting[docname]
            app.executing[docname] = app.executors.submit(  # type: ignore[attr-defined]
                single_nb_execution,
                notebook,
                cwd=str(path.parent),
                timeout=config.execution_timeout,
                allow_errors=config.execution_allow_errors,
                coalesce_streams=True,  # what one line prints may come in pieces, and MyST-NB would break the line
            )


def await_outputs(app: Sphinx, docname: str, _source: list[str]) -> None:
    """Put the outputs of a chapter into the cache before it is read."""
    job: Future[ExecutionResult] | None = app.executing.pop(docname, None)  # type: ignore[attr-defined]
    if job is None:
        return
    path, result = app.env.doc2path(docname), job.result()
    if result.err is not None:
        logger.info("%s: failed after %.1f s", Path(path).name, result.time)
        return
    bundle = CacheBundleIn(result.nb, path, data={"execution_seconds": result.time})
    cache = get_cache(app.env.mystnb_config.execution_cache_path)  # type: ignore[attr-defined]
    cache.cache_notebook_bundle(bundle, check_validity=False, overwrite=True)
    logger.info("%s: executed in %.1f s", Path(path).name, result.time)


def end(app: Sphinx, _exception: Exception | None) -> None:
    """Leave no kernel behind where the build was cut short."""
    if executors := getattr(app, "executors", None):
        executors.shutdown(cancel_futures=True)


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.connect("env-before-read-docs", begin)
    app.connect("source-read", await_outputs)
    app.connect("build-finished", end)
    return {"parallel_read_safe": False, "parallel_write_safe": True}
