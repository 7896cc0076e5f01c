"""The pictures of docs/gallery.md: each example is run, and what it computed is drawn; some minutes for all of them.

Those at the head of README and of other pages are among them: demo.png and parts.png.

python docs/gallery.py                  # all, into docs/gallery
python docs/gallery.py 04 10            # some
python docs/gallery.py 04 -o FOLDER     # elsewhere
"""

from __future__ import annotations

import argparse
import contextlib
import io
import os
import runpy
import sys
import tempfile
from pathlib import Path

from drawn import DRAWN, in_fewer_colours

ROOT = Path(__file__).resolve().parents[1]
PICTURES = ROOT / "docs" / "gallery"
LARGE = 130_000  # bytes of a picture that is drawn in fewer colours; set by hand


def draw(name: str, folder: Path) -> Path:
    """Run an example in an empty folder, and draw what it computed."""
    script = ROOT / "examples" / f"{name}.py"
    picture = folder.resolve() / f"{script.stem}.png"
    with tempfile.TemporaryDirectory() as empty, contextlib.chdir(empty), contextlib.redirect_stdout(io.StringIO()):
        sys.argv, path = [script.name, "morphometrics"], list(sys.path)
        sys.path.insert(0, str(script.parent))
        try:
            DRAWN[name](picture, runpy.run_path(str(script), run_name="__main__"))
        finally:
            sys.path[:] = path
    if picture.stat().st_size > LARGE:
        in_fewer_colours(picture)
    return picture


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help="how the names of examples begin; all, if none is given")
    parser.add_argument("-o", "--output", type=Path, default=PICTURES)
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    for name in DRAWN:
        if not options.names or name.startswith(tuple(options.names)):
            print(os.path.relpath(draw(name, options.output)))


if __name__ == "__main__":
    main()
