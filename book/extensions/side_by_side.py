"""Execute chapters side by side on the cores, before Sphinx reads them one after the other.

Each chapter runs in a kernel of its own, so a thread has only to wait for it. Outputs go into the cache that
MyST-NB reads from. A chapter that fails is left to it: it executes the chapter again and says what is wrong.
"""

from __future__ import annotations

import os
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
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


def execute_side_by_side(_app: Sphinx, env: BuildEnvironment, docnames: list[str]) -> None:
    """Execute those of the pages to be read whose outputs are not known, longest text first."""
    config: NbParserConfig = env.mystnb_config  # type: ignore[attr-defined]
    if config.execution_mode != "cache":
        return
    cache = get_cache(config.execution_cache_path)
    waiting: list[tuple[Path, NotebookNode]] = []
    for docname in docnames:
        path = Path(env.doc2path(docname))
        notebook = None if is_excluded(path, config) else notebook_of(env, docname)
        if notebook is not None:
            try:
                cache.match_cache_notebook(notebook)
            except KeyError:
                waiting.append((path, notebook))
    waiting.sort(key=lambda one: -one[0].stat().st_size)
    with ThreadPoolExecutor(max(2, cores())) as threads:
        running: dict[Future[ExecutionResult], Path] = {}
        for path, notebook in waiting:
            job = threads.submit(
                single_nb_execution,
                notebook,
                cwd=str(path.parent),
                timeout=config.execution_timeout,
                allow_errors=config.execution_allow_errors,
            )
            running[job] = path
        for job in as_completed(running):
            name, result = running[job].name, job.result()
            if result.err is not None:
                logger.info("%s: failed after %.1f s", name, result.time)
                continue
            bundle = CacheBundleIn(result.nb, str(running[job]), data={"execution_seconds": result.time})
            cache.cache_notebook_bundle(bundle, check_validity=False, overwrite=True)
            logger.info("%s: executed in %.1f s", name, result.time)


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.connect("env-before-read-docs", execute_side_by_side)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
