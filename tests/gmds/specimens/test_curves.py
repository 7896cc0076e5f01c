"""Points of curves slide along them on every specimen, and nothing else does."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from generated_shapes import bumpy_sphere

from geodesics import Mesh, SurfacePoints
from geodesics.errors import BadArgument
from gmds.landmarks.files.named_points import Landmarks, PointList
from gmds.maps.point_map import MatchStatus
from gmds.morphometrics.procrustes import superimposed
from gmds.specimens.carried import Landmarked, Specimen
from gmds.specimens.curves import curve_triples, with_slid_curves
from gmds.specimens.tables import write_tables

SPHERE = bumpy_sphere(3)
POLES = np.vstack([np.eye(3), -np.eye(3)])
COUNT = 7  # points of the curve
LISTS = (PointList("Fiducial", "F", 6), PointList("Curve", "C", COUNT))


def specimen(number: int) -> Specimen:
    """A sphere stretched a little, with its poles and points of an arc that are unevenly spread."""
    stretch = 1 + 0.03 * np.random.default_rng(number).normal(size=3)
    mesh = Mesh(SPHERE.vertices * stretch, SPHERE.faces)
    uneven = np.linspace(0.3, 1.2, COUNT) + 0.04 * np.random.default_rng(10 + number).normal(size=COUNT)
    arc = np.column_stack([np.cos(uneven), np.sin(uneven), np.zeros(COUNT)])
    places = SurfacePoints.closest(mesh, np.vstack([POLES, arc]) * stretch).positions
    n = len(places)
    return Specimen(f"s{number}", mesh, MatchStatus.GOOD, places, np.ones(n), np.ones(n, bool))


@pytest.fixture(scope="module")
def found() -> Landmarked:
    specimens = tuple(specimen(i) for i in range(4))
    names = tuple(map(str, range(6 + COUNT)))
    return Landmarked(Landmarks(names, specimens[0].positions, lists=LISTS), specimens, {})


def test_a_landmark_on_no_specimen_stays_missing_and_the_others_are_superimposed(
    found: Landmarked, tmp_path: Path
) -> None:
    lost = np.arange(6 + COUNT) != 2
    gone = tuple(
        replace(one, valid=lost, positions=np.where(lost[:, None], one.positions, np.nan)) for one in found.specimens
    )
    told = write_tables(tmp_path, replace(found, specimens=gone))
    assert ("all", "on no specimen: 2") in told and not any("superposition" in why for _, why in told)
    rows = (tmp_path / "shapes.csv").read_text().splitlines()
    assert len(rows) == 1 + 4 * (6 + COUNT) and sum(row.endswith("NA,NA,NA") for row in rows) == 4
    laid = superimposed(np.stack([one.positions[lost] for one in found.specimens]))
    wide = (tmp_path / "shapes_wide.csv").read_text().splitlines()[1].split(",")
    assert np.isclose(float(wide[1]), laid.sizes[0]) and np.isclose(float(wide[2]), laid.distances[0])


def apart(found: Landmarked) -> float:
    return float(superimposed(np.stack([one.positions for one in found.specimens])).distances.sum())


def test_ends_of_open_curves_do_not_slide_and_those_of_closed_ones_do() -> None:
    lists = [PointList("Fiducial", "F", 2), PointList("Curve", "C", 4), PointList("ClosedCurve", "R", 3)]
    assert curve_triples(lists) == [(2, 3, 4), (3, 4, 5), (8, 6, 7), (6, 7, 8), (7, 8, 6)]
    assert curve_triples([PointList("Fiducial", "F", 5), PointList("Curve", "C", 2)]) == []


@pytest.mark.parametrize("by", ["bending", "procrustes"])
def test_only_points_within_a_curve_move_and_stay_on_the_surface(found: Landmarked, by: str) -> None:
    after = with_slid_curves(found, by)  # type: ignore[arg-type]
    assert apart(after) < 0.8 * apart(found)
    for one, other in zip(found.specimens, after.specimens, strict=True):
        moved = np.linalg.norm(other.positions - one.positions, axis=1)
        assert (moved[[*range(7), 12]] == 0).all() and (moved[7:12] > 1e-4).all()
        assert np.abs(SurfacePoints.closest(one.mesh, other.positions).positions - other.positions).max() < 1e-9


def test_points_beside_one_that_some_specimen_lacks_stay(found: Landmarked) -> None:
    lame = found.specimens[2]
    valid = lame.valid.copy()
    valid[9] = False
    lacking = replace(found, specimens=(*found.specimens[:2], replace(lame, valid=valid), found.specimens[3]))
    after = with_slid_curves(lacking, "bending")
    moved = np.linalg.norm(after.specimens[0].positions - found.specimens[0].positions, axis=1) > 0
    assert np.flatnonzero(moved).tolist() == [7, 11]


def test_where_there_is_no_curve_nothing_slides(found: Landmarked) -> None:
    with pytest.raises(BadArgument, match="no curve"):
        with_slid_curves(replace(found, marks=replace(found.marks, lists=())), "bending")
    gone = tuple(replace(one, valid=np.arange(6 + COUNT) < 4) for one in found.specimens)
    with pytest.raises(BadArgument, match="all specimens have 4 landmarks"):
        with_slid_curves(replace(found, specimens=gone), "bending")
