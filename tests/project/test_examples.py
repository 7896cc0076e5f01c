"""Every example runs as it stands, and prints what it claims."""

from __future__ import annotations

import re
import runpy
from pathlib import Path

import pytest
from places import ROOT

from gmds.shapes import quadruped

EXAMPLES = sorted((ROOT / "examples").glob("[0-9][0-9]_*.py"))


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture):
    """What an example prints; where it leaves the number of vertices to us, it may be told one."""
    monkeypatch.chdir(tmp_path)

    def printed(number: int, n_vertices: int = 5000) -> str:
        monkeypatch.setitem(quadruped.__kwdefaults__, "n_vertices", n_vertices)
        runpy.run_path(str(EXAMPLES[number - 1]), run_name="__main__")
        return capsys.readouterr().out

    return printed


def table(text: str, pattern: str) -> dict[tuple[str, ...], float]:
    """Numbers by the words before them: the last group of the pattern is the number."""
    return {found[:-1]: float(found[-1]) for found in re.findall(pattern, text)}


def test_examples_are_numbered_without_gaps() -> None:
    assert [int(path.name[:2]) for path in EXAMPLES] == list(range(1, len(EXAMPLES) + 1)) and len(EXAMPLES) >= 9


def test_01_read_and_measure(run) -> None:
    lines = run(1).splitlines()
    assert lines[0] == "Mesh(2000 vertices, 3996 faces)"
    assert float(lines[1].split(":")[1]) == pytest.approx(1)


def test_02_match_two_shapes(run, tmp_path: Path) -> None:
    mean = float(re.search(r"mean=(\S+?)[,)]", run(2)).group(1))
    assert mean < 3  # times 100; 1.4 when written
    assert {path.name for path in tmp_path.iterdir()} == {"map.npz", "map.html", "map.png"}


def test_03_scale_invariant_distances_survive_local_scaling(run) -> None:
    change = table(run(3), r"(\w+)\s+(diffusion|commute time|geodesic)\s+distances change by\s+([\d.]+) %")
    assert len(change) == 6
    assert change["scale_invariant", "diffusion"] < 0.2 * change["embedded", "diffusion"]
    assert change["scale_invariant", "commute time"] < 0.5 * change["embedded", "commute time"]
    assert change["scale_invariant", "geodesic"] < 0.6 * change["embedded", "geodesic"]


def test_04_voronoi_cells_survive_local_scaling(run, tmp_path: Path) -> None:
    kept = table(run(4), r"(\w+)\s+(\d+) % of the surface")
    assert kept["scale_invariant",] > 2 * kept["embedded",]
    assert (tmp_path / "embedded.png").exists() and (tmp_path / "scale_invariant.png").exists()


def test_05_signatures_survive_local_scaling(run) -> None:
    change = table(run(5), r"(\w+) +([\w -]+?) +moves by ([\d.]+)")
    assert len(change) == 8
    for metric, name in change:
        if metric == "embedded":
            assert change["scale_invariant", name] < 0.5 * change["embedded", name], name


def test_06_landmarks_do_not_hurt(run) -> None:
    errors = table(run(6), r"(with|without)\s+landmarks: mean error x100 ([\d.]+)")
    assert errors["with",] < 10 and errors["with",] <= errors["without",] + 1


def test_07_gmds_by_hand_lowers_the_error(run) -> None:
    text = run(7)
    start = float(re.search(r"start: mean error x100 ([\d.]+)", text).group(1))
    errors = table(text, r"(\w+) +stress [\d.]+, error x100 ([\d.]+)")
    assert set(errors) == {("LeastSquares",), ("Huber",), ("Minimax",)}
    assert errors["LeastSquares",] < start and errors["Huber",] < start


def test_08_only_the_gaussian_arc_length_survives_size_and_bending(run) -> None:
    rows = {row[0]: (float(row[1]), float(row[2])) for row in re.findall(r"(\w+) +([\d.]+) % +([\d.]+) %", run(8))}
    assert rows.pop("ds") == (100.0, pytest.approx(0, abs=0.1))
    assert max(rows.pop("gaussian_curvature")) < 0.5
    assert len(rows) == 3 and all(size < 0.1 and bent > 2 for size, bent in rows.values())


def test_09_transfer(run) -> None:
    text = run(9)
    assert float(re.search(r"([\d.]+) % of the labels", text).group(1)) > 99
    assert float(re.search(r"again: ([\d.]+) away", text).group(1)) < 0.01
    assert "saved and loaded: True" in text


def test_10_eigenfunctions_survive_local_scaling(run) -> None:
    kept = table(run(10), r"(\w+) +matched eigenfunctions correlate by ([\d.]+)")
    assert kept["scale_invariant",] > 0.9 > kept["embedded",]


def test_11_a_part_finds_its_place(run, tmp_path: Path) -> None:
    text = run(11, 500)  # a reader waits half a minute for 5,000
    here, there = (int(word) for word in re.search(r"(\d+) % of the part and (\d+) % of the whole", text).groups())
    assert here > 97 and 55 < there < 67
    assert float(re.search(r"mean error x100 ([\d.]+)", text).group(1)) < 2.5  # 0.6 when written
    assert 55 < int(re.search(r"back: (\d+) %", text).group(1)) < 67
    assert (tmp_path / "parts.png").exists()


def test_12_canonical_forms_bring_poses_together(run) -> None:
    apart = table(run(12), r"(as they are|\|K\|\^\d g, [a-z ]+?) +([\d.]+) % apart")
    plain = apart.pop(("as they are",))
    assert len(apart) == 6 and max(apart.values()) < plain
    assert apart["|K|^1 g, least squares",] < 0.7 * plain


def test_13_functional_maps(run) -> None:
    errors = table(run(13), r"(descriptors|zoomed out|mirrored|from the truth) .*mean error x100 +([\d.]+)")
    assert errors["zoomed out",] < 2.5 < errors["descriptors",] < errors["mirrored",]


def test_14_spectral_gmds_improves_a_rough_map(run) -> None:
    errors = table(run(14), r"(rough map|orthogonal matrix|points on the triangles) +mean error x100 +([\d.]+)")
    rough = errors.pop(("rough map",))
    assert len(errors) == 2 and max(errors.values()) < 0.5 * rough


def test_17_partial_gmds_leaves_out_what_has_no_counterpart(run) -> None:
    said = run(17)
    errors = table(said, r"(rough map|all samples|a part of them) +mean error x100 +([\d.]+)")
    assert errors["a part of them",] < errors["rough map",] < errors["all samples",]
    ((left, kept),) = re.findall(r"without counterpart ([\d.]+), with ([\d.]+)", said)
    assert float(left) < 0.3 and float(kept) > 0.8


def test_15_bounds_hold_and_a_large_head_matters_less_in_the_invariant_metric(run) -> None:
    row = r"(space|invariant) +(.+?) +Hausdorff ([\d.]+) to ([\d.]+), Wasserstein ([\d.]+) to ([\d.]+)"
    found = re.findall(row, run(15))
    assert len(found) == 12
    assert all(float(row[2]) <= float(row[3]) and float(row[4]) <= float(row[5]) for row in found)
    upper = {(row[0], row[1]): float(row[5]) for row in found}
    assert upper["invariant", "standing, large head"] < upper["space", "standing, large head"]


def test_16_the_metric_undoes_a_caricature(run) -> None:
    rows = re.findall(r"gamma ([\d.]+): .*change by +([\d.]+) % in space, +([\d.]+) % in", run(16))
    space, invariant = (float(x) for x in rows[-1][1:])
    assert len(rows) == 3 and invariant < 0.6 * space
