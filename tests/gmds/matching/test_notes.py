"""Notes with codes: on a mesh, on a match, and that all of them are documented."""

from __future__ import annotations

import re
from pathlib import Path

import generated_shapes as shapes
import pytest
from matched_shapes import bumpy

import geodesics.check
import geodesics.io
import gmds.matching.notes
from geodesics import Mesh
from geodesics.check import check
from geodesics.topology.invariants import Invariants, invariants
from gmds.appearance import keeping
from gmds.maps.point_map import MatchStatus
from gmds.matching.notes import match_notes

ROOT = Path(geodesics.check.__file__).resolve().parents[1]


def codes(mesh: Mesh) -> set[str]:
    return {note.code for note in check(mesh)}


def test_every_note_is_documented() -> None:
    used = {code for path in ROOT.glob("g*/**/*.py") for code in re.findall(r'"(W\d{3})"', path.read_text("utf-8"))}
    tables = f"{geodesics.check.__doc__}{geodesics.io.__doc__}{gmds.matching.notes.__doc__}{keeping.__doc__}"
    assert used == set(re.findall(r"^\| (W\d{3}) \|", tables, re.MULTILINE))


@pytest.mark.parametrize(
    ("mesh", "expected"),
    [
        (shapes.icosphere(2), Invariants(1, 0, 2, 0)),
        (shapes.torus(20, 10), Invariants(1, 0, 0, 1)),
        (shapes.rectangle(6, 6), Invariants(1, 1, 1, 0)),
        (shapes.joined(shapes.icosphere(1), shapes.torus(20, 10)), Invariants(2, 0, 2, 1)),
    ],
    ids=["sphere", "torus", "rectangle", "sphere and torus"],
)
def test_invariants_of_surfaces_that_have_known_ones(mesh: Mesh, expected: Invariants) -> None:
    assert invariants(mesh) == expected
    assert invariants(shapes.moved(mesh, 1e-6)) == expected


def test_surfaces_of_different_topology_are_named() -> None:
    ball, ring = shapes.icosphere(1), shapes.torus(20, 10)
    assert match_notes(ball, bumpy(), MatchStatus.GOOD) == []
    (note,) = match_notes(ball, ring, MatchStatus.POOR)
    assert str(note) == (
        "W205: different topology: the source has 1 component, 0 boundary loops, genus 0; "
        "the target has 1 component, 0 boundary loops, genus 1"
    )
    assert match_notes(ball, ring, MatchStatus.GOOD, of_a_part=True) == []


def test_a_match_carries_its_notes() -> None:
    ring = shapes.torus(20, 10)
    answer = gmds.match(ring, ring)  # round: turned by any angle it is the same
    assert answer.status is MatchStatus.AMBIGUOUS
    assert [line[:4] for line in answer.meta["notes"]] == ["W207"]
    assert next(line[:4] for line in gmds.match(bumpy(), ring).meta["notes"]) == "W205"


def test_flat_surfaces_are_told_where_the_metric_says_nothing() -> None:
    for flat in (shapes.rectangle(12, 12), shapes.moved(shapes.rectangle(12, 12), 1e9), shapes.cylinder(40, 20)):
        assert "W206" in codes(flat)
    for curved in (shapes.icosphere(2), shapes.torus(24, 12), bumpy()):
        assert "W206" not in codes(curved)
