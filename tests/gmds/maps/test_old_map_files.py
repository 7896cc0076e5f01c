"""Files that the first version with a map.npz wrote: no confidence, no names of landmarks. They load, and go on."""

from __future__ import annotations

import base64
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from geodesics import Mesh, write_mesh
from gmds import Correspondence
from gmds.cli import main
from gmds.maps.point_map import MatchStatus
from gmds.report.page import write_report

CORNERS = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], dtype=np.float64)
FACES = np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
SOURCE, TARGET = Mesh(CORNERS, FACES), Mesh(2 * CORNERS[[1, 0, 3, 2]], FACES)

# `save` of the commit that brought map.npz: vertices 0 to 3 on faces 0 to 3 of the target, the third without partner
WRITTEN_THEN = """
UEsDBC0AAAAIAAAAIQD+dB7U//////////8IABQAZmFjZS5ucHkBABAAkAAAAAAAAABOAAAAAAAAAJvsF+obEMnIUMZQrZ6SWpxcpG6loG6TaaKu
o6Cell9UUpSYF59flJIKEndLzClOBYoXZyQWpAL5GiY6mjoKtQoUAC4GIGAEYiYgZgZiAFBLAwQtAAAACAAAACEA5tkl0P//////////DwAUAGJh
cnljZW50cmljLm5weQEAEADgAAAAAAAAAFwAAAAAAAAAm+wX6hsQychQxlCtnpJanFykbqWgbpNmoa6joJ6WX1RSlJgXn1+UkgoSd0vMKU4Fihdn
JBakAvkaJjoKxpo6CrUKZAMuBjD4YM+AFTywR6Vh4II9Ko0u/wIuDwBQSwMELQAAAAgAAAAhAHU3l/7//////////woAFAB2ZXJ0ZXgubnB5AQAQ
AKAAAAAAAAAASgAAAAAAAACb7BfqGxDJyFDGUK2eklqcXKRupaBuk2mhrqOgnpZfVFKUmBefX5SSChJ3S8wpTgWKF2ckFqQC+RomOpo6CrUKFAAu
BjTAjEYDAFBLAwQtAAAACAAAACEA9K+NIv//////////CQAUAHZhbGlkLm5weQEAEACEAAAAAAAAAEgAAAAAAAAAm+wX6hsQychQxlCtnpJanFyk
bqWgXpNkqK6joJ6WX1RSlJgXn1+UkgoSd0vMKU4FihdnJBakAvkaJjqaOgq1ChQALkZGBkYAUEsDBC0AAAAIAAAAIQAxQy7Q//////////8OABQA
ZGlzdG9ydGlvbi5ucHkBABAAkAAAAAAAAABOAAAAAAAAAJvsF+obEMnIUMZQrZ6SWpxcpG6loG6TZqKuo6Cell9UUpSYF59flJIKEndLzClOBYoX
ZyQWpAL5GiY6mjoKtQoUAC4GMGiwAxL2QGwHAFBLAwQtAAAACAAAACEA4rC5xf//////////CAAUAG1ldGEubnB5AQAQAOABAAAAAAAAIQEAAAAA
AACdkL1OAzEQhEPLU5zcHEiHZPv8c06NoILQUCCEoj17nUTK/ch20oQ8BS+MHVEiCrba+TTaGe3X8+vTy9vV4rg41Q6jDfWyqj8PrG6q2k8hBRjX
U3BY+APsI2YetzBj1jet5M1tU52rf8/1ieSUARJZVmQzuHg3wEyaioxTwpjhe95GJB8ZzRBgwISh8BMZ1xGGeX9xMUrP2RERXVa0rNMhWLwYPdiL
SRS8BS5VCVNeCyoZGqm1BU+5Nr3trMAWue5Z1zLZauGkYoBetdw7ZrRUvQOhO9NiKXnEkHY/xy/5CdKhKPK4Wt0XR4KwwfRHDbASQHnjPNXUGMq9
1OARkPVUOMY639JeCqsot1J1xuVa3uWa3FkQQv9WI+u4m8byl/M3UEsBAi0DLQAAAAgAAAAhAP50HtROAAAAkAAAAAgAAAAAAAAAAAAAAIABAAAA
AGZhY2UubnB5UEsBAi0DLQAAAAgAAAAhAObZJdBcAAAA4AAAAA8AAAAAAAAAAAAAAIABiAAAAGJhcnljZW50cmljLm5weVBLAQItAy0AAAAIAAAA
IQB1N5f+SgAAAKAAAAAKAAAAAAAAAAAAAACAASUBAAB2ZXJ0ZXgubnB5UEsBAi0DLQAAAAgAAAAhAPSvjSJIAAAAhAAAAAkAAAAAAAAAAAAAAIAB
qwEAAHZhbGlkLm5weVBLAQItAy0AAAAIAAAAIQAxQy7QTgAAAJAAAAAOAAAAAAAAAAAAAACAAS4CAABkaXN0b3J0aW9uLm5weVBLAQItAy0AAAAI
AAAAIQDisLnFIQEAAOABAAAIAAAAAAAAAAAAAACAAbwCAABtZXRhLm5weVBLBQYAAAAABgAGAFQBAAAXBAAAAAA=
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "old.npz"
    path.write_bytes(base64.b64decode(WRITTEN_THEN))
    return path


def test_it_loads_with_all_that_it_says(file: Path) -> None:
    old = Correspondence.load(file, SOURCE, TARGET)
    assert old.points.face.tolist() == [0, 1, 2, 3]
    assert old.points.barycentric.tolist() == [[1, 0, 0], [0.5, 0.5, 0], [0.25, 0.25, 0.5], [0, 0.75, 0.25]]
    assert old.valid.tolist() == [True, True, False, True]
    assert old.distortion.tolist() == [0, 0.25, 0.5, 0.125]
    assert old.status is MatchStatus.GOOD and old.meta["parameters"] == {"n_samples": 100}
    assert np.isnan(old.confidence).all(), "nobody asked how far it can be trusted"


def test_it_is_saved_again_shown_and_exported(file: Path, tmp_path: Path) -> None:
    old = Correspondence.load(file, SOURCE, TARGET)
    old.save(tmp_path / "again.npz")
    again = Correspondence.load(tmp_path / "again.npz", SOURCE, TARGET)
    assert (again.points.barycentric == old.points.barycentric).all() and again.meta == old.meta
    write_report(tmp_path / "page.html", old)
    ends = [tmp_path / "source.off", tmp_path / "target.off"]
    for mesh, path in zip((SOURCE, TARGET), ends, strict=True):
        write_mesh(mesh, path)
    words = ["export", file, "--source", ends[0], "--target", ends[1], "-o", tmp_path / "map.csv"]
    told = CliRunner().invoke(main, [str(word) for word in words])
    assert told.exit_code == 0, told.output
    assert len((tmp_path / "map.csv").read_text().splitlines()) == 1 + len(CORNERS)
