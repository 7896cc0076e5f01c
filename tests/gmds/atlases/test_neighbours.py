"""Specimens registered from one another: nearer the truth than where they started, kept, made again where needed."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geodesics import SurfacePoints
from gmds.atlases.neighbours import Job, kept, neighbours_of, settle
from gmds.batch.collection import Shape
from gmds.batch.store import Store
from gmds.matching.settling import CommonPoints
from gmds.shapes import quadruped, truth


def test_each_is_registered_from_others_evenly_and_never_from_the_template_or_itself() -> None:
    names = list("abcdefg")
    pairs = neighbours_of(names, 4, "c")
    assert len(pairs) == len(set(pairs)) == 6 * 4
    assert all(source != target and "c" not in (source, target) for source, target in pairs)
    assert {source for source, _ in pairs} == set("abdefg")
    assert len(neighbours_of(names, 99, "mean-shape")) == 7 * 6
    assert neighbours_of(list("abcd"), 4, "b") == [] and neighbours_of(names, 0, "a") == []
    once = neighbours_of(names, 1, "a")
    assert sorted(source for source, _ in once) == sorted(target for _, target in once) == list("bcdefg")


def test_what_slid_along_slides_back_and_is_kept(tmp_path: Path) -> None:
    source, target = quadruped(n_vertices=500), quadruped("walk", leg_scale=1.2, n_vertices=450, seed=1)
    right = truth(source, target).positions
    size = np.sqrt(target.area)
    slid = SurfacePoints.closest(target, right + 0.08 * size * np.cos(6 * source.vertices / size)).positions
    store = Store(tmp_path)
    records = [store.keep(Shape(name, mesh)) for name, mesh in (("a", source), ("b", target))]
    job = Job(*records, store, CommonPoints(source.vertices, slid, source.faces), tmp_path / "a__b.npz")
    assert kept(job) is None
    settle(job)
    found = kept(job)
    assert found is not None
    error, before = (np.linalg.norm(x - right, axis=1).mean() / size for x in (found, slid))
    assert error < 0.6 * before and np.abs(SurfacePoints.closest(target, found).positions - found).max() < 1e-9 * size
    written = job.path.read_bytes()
    settle(job)
    assert job.path.read_bytes() == written
    other = Job(*records, store, CommonPoints(source.vertices, right, source.faces), job.path)
    assert kept(other) is None
    job.path.write_bytes(written[:500])
    assert kept(job) is None
