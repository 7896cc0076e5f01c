"""What happened to each shape and each pair: the records that manifest and summary are written from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gmds.batch.cycles import Consistency

TIMED_OUT, WORKER_DIED, UNEXPECTED, NO_MEMORY, UNREADABLE = "E504", "E505", "E500", "E501", "E202"
WITHOUT_MAP = ("failed", "missing")  # the statuses of pairs without a map


@dataclass(frozen=True)
class Failure:
    """Why something could not be done: a stable code and a sentence."""

    code: str
    reason: str

    @classmethod
    def of(cls, error: BaseException) -> Failure:
        """The failure that an exception reports."""
        reason = str(error) or type(error).__name__
        code = getattr(error, "code", None)
        if isinstance(code, str):
            return cls(code, reason.removeprefix(f"{code}: "))
        if isinstance(error, MemoryError):
            return cls(NO_MEMORY, f"not enough memory ({reason})")
        if isinstance(error, OSError):
            return cls(UNREADABLE, reason)
        return cls(UNEXPECTED, f"{type(error).__name__}: {reason}")


@dataclass(frozen=True)
class ShapeRecord:
    """A shape: its size, the SHA-256 of its mesh, and the `key` under which its measured surface is stored.

    `usable`: vertices of its largest part. `kept`: whether it was stored before. `seconds` of CPU time. With a
    `failure` nothing else is known.
    """

    name: str
    vertices: int = 0
    faces: int = 0
    usable: int = 0
    sha256: str = ""
    key: str = ""
    seconds: float = 0.0
    kept: bool = False
    failure: Failure | None = None


@dataclass(frozen=True)
class PairRecord:
    """A pair: the status of its map, the share of valid vertices, the median distortion, stress and margin.

    `blame`: how far around triangles of shapes points go astray with this map in it, see `Consistency.blame`. `kept`:
    whether the map was there before. `seconds` of CPU time. With a `failure` there is no map; `status` is then
    "failed", or "missing" when its turn never came.
    """

    source: str
    target: str
    status: str = "missing"
    valid: float | None = None
    distortion: float | None = None
    stress: float | None = None
    margin: float | None = None
    blame: float | None = None
    seconds: float = 0.0
    kept: bool = False
    failure: Failure | None = None

    @property
    def name(self) -> str:
        """A__B, as in the name of the file."""
        return f"{self.source}__{self.target}"

    def cells(self) -> dict[str, Any]:
        """The row of the summary: nothing that another run would tell differently."""
        failure = self.failure or Failure("", "")
        figures = {name: getattr(self, name) for name in ("valid", "distortion", "stress", "margin", "blame")}
        return {
            "source": self.source,
            "target": self.target,
            "status": self.status,
            **figures,
            "code": failure.code,
            "reason": failure.reason,
        }


@dataclass(frozen=True, eq=False)
class Batch:
    """What came of a collection: a record of every shape and of every pair, in the order of the pairs.

    `consistency`: whether the maps agree around triangles of shapes.
    """

    output: Path
    shapes: Mapping[str, ShapeRecord]
    pairs: tuple[PairRecord, ...]
    consistency: Consistency

    @property
    def failed(self) -> tuple[PairRecord, ...]:
        """Pairs without a map."""
        return tuple(pair for pair in self.pairs if pair.status in WITHOUT_MAP)

    def map_file(self, pair: PairRecord) -> Path:
        """Where the map of a pair is."""
        return self.output / "pairs" / f"{pair.name}.npz"
