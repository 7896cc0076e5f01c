"""What holds for the whole run: few threads, random cases that are the same every time, built-in shapes made once."""

from __future__ import annotations

import gc
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # small matrices everywhere, and machines that are shared

# a slow machine fails no test, and neither does a case that is new today (--hypothesis-profile=default draws others)
settings.register_profile("same", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("same")

FIGURES = pytest.StashKey[str]()  # a folder of this run, which its workers share


def pytest_configure(config: pytest.Config) -> None:
    """From here on the built-in shapes are made once in a run, not once in every test."""
    import drawing_process  # after the limits above, which BLAS reads when it is loaded
    import figures_once
    import forked_workers

    given = getattr(config, "workerinput", {}).get("figures")
    if given is None:
        own = tempfile.TemporaryDirectory(prefix="gmds-figures-")
        config.add_cleanup(own.cleanup)
        given = own.name
    config.stash[FIGURES] = given
    patch = pytest.MonkeyPatch()
    figures_once.use(figures_once.kept_in(Path(given)), patch)
    for end in (forked_workers.use(patch), drawing_process.use(patch)):
        config.add_cleanup(end)
    config.add_cleanup(patch.undo)


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Iterator[None]:
    """No search for garbage while tests are collected, and none later among what that made: none of it is garbage."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """`project` comes first, whose files take longest: else a worker is left with one when the others are done."""
    items.sort(key=lambda item: os.path.relpath(item.path, Path(__file__).parent).split(os.sep)[0], reverse=True)


@pytest.hookimpl(optionalhook=True)
def pytest_configure_node(node: Any) -> None:
    """Each worker of pytest-xdist is told the folder."""
    node.workerinput["figures"] = node.config.stash[FIGURES]


@pytest.fixture(scope="module")
def few_faces() -> Iterator[None]:
    """Meshes with half as many vertices are simplified by as much as whole ones are: to half as many faces."""
    from gmds.registration.deformable import SIMPLIFIED_FACES, DeformableMesh

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(DeformableMesh.simplified.__func__, "__defaults__", (SIMPLIFIED_FACES // 2,))  # type: ignore[attr-defined]
        yield
