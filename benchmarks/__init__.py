"""How good, how fast, how stable: the scripts behind every published figure; results/ has the tables.

They run from the top of the project, `python -m benchmarks.accuracy.accuracy`, on the same helpers as the tests.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
