"""How much memory a process held at the most."""

from __future__ import annotations

import resource
from pathlib import Path

STATUS = Path("/proc/self/status")


def peak_megabytes() -> float:
    """The most resident memory of this process, in MB of 1,024 squared bytes.

    On Linux `VmHWM`: `ru_maxrss` of a process that another one started is never less than what that one held then.
    """
    if STATUS.exists():
        rows = dict(line.split(":", 1) for line in STATUS.read_text(encoding="utf-8").splitlines())
        return int(rows["VmHWM"].split()[0]) / 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
