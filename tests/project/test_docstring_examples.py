"""Whatever is public has an example in its docstring, and prints what the example says."""

from __future__ import annotations

import contextlib
import doctest
import functools
import importlib
import inspect
import pkgutil
from collections.abc import Iterator
from typing import Any

import docs_files
import pytest

import gmds
import gmds.batch
import gmds.shapes

needs_extras = [pytest.importorskip(name) for name in ("distributed", "plotly")]
PUBLIC = [f"{package}.{name}" for package in ("geodesics", "gmds") for name in importlib.import_module(package).__all__]
quadruped, humanoid = (functools.cache(make) for make in (gmds.shapes.quadruped, gmds.shapes.humanoid))


def example_of(name: str) -> doctest.DocTest:
    text = inspect.getdoc(pkgutil.resolve_name(name)) or ""
    return doctest.DocTestParser().get_doctest(text, {"__name__": "__main__"}, name, None, 0)


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    with gmds.batch.local_client(1) as client:
        yield client


@pytest.mark.parametrize("name", PUBLIC)
def test_an_example_prints_what_it_says(name: str, monkeypatch: pytest.MonkeyPatch, request: Any) -> None:
    example = example_of(name)
    assert any(step.want for step in example.examples), "no example, or one that shows nothing"
    called = any(f"{name}(" in step.source for step in example.examples)
    assert called or inspect.isclass(pkgutil.resolve_name(name)), "an example of something else"
    monkeypatch.setattr(gmds.shapes, "quadruped", quadruped)  # the same animals are made once
    monkeypatch.setattr(gmds.shapes, "humanoid", humanoid)
    monkeypatch.setitem(vars(gmds), "match", docs_files.match)
    if "__main__" in "".join(step.source for step in example.examples):
        client = request.getfixturevalue("client")
        monkeypatch.setattr("gmds.batch.local_client", lambda workers: contextlib.nullcontext(client))
    told: list[str] = []
    failed = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(example, out=told.append).failed
    assert not failed, "".join(told)
