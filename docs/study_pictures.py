"""The pictures of docs/howto/study.md, of the study that examples/study makes of twelve animals; three minutes.

python docs/study_pictures.py              # runs the study in an empty folder
python docs/study_pictures.py --of STUDY   # of one that was made before

The picture of the page needs playwright, and a chromium (in the environment as CHROMIUM, or on the path).
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from drawn import in_fewer_colours

ROOT = Path(__file__).resolve().parents[1]
PICTURES = ROOT / "docs" / "howto" / "study"
DRAWN = {
    "atlas.png": "atlas/atlas.png",
    "modes.png": "model/modes.png",
    "growth.png": "growth.png",
    "groups.png": "groups/points.png",
}
WIDTH, HEIGHT = 1280, 900  # pixels of the window that shows the page


def draw(study: Path) -> None:
    """Copy what the study has drawn, and look at its page."""
    for name, made in DRAWN.items():
        shutil.copy(study / made, PICTURES / name)
    look_at(study / "model" / "model.html", PICTURES / "page.png")
    in_fewer_colours(PICTURES / "page.png")  # the others have ranges of colours, which would show steps
    for picture in sorted(PICTURES.glob("*.png")):
        print(os.path.relpath(picture))


def look_at(page: Path, picture: Path) -> None:
    """The whole of a page as a browser shows it."""
    from playwright.sync_api import sync_playwright

    program = os.environ.get("CHROMIUM") or shutil.which("chromium") or shutil.which("chromium-browser")
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=program, args=["--no-sandbox"])
        shown = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
        shown.goto(page.resolve().as_uri())
        shown.wait_for_timeout(500)  # ms, until everything is drawn
        shown.screenshot(path=picture, full_page=True)
        browser.close()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--of", type=Path, metavar="STUDY")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as empty:
        study = given.of or Path(empty) / "study"
        if given.of is None:
            script = ROOT / "examples" / "study" / "study.py"
            subprocess.run([sys.executable, script, "-o", study], check=True)
        draw(study)


if __name__ == "__main__":
    main()
