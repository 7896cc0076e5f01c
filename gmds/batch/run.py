"""match_collection(): many pairs in parallel, into a folder from which a later run resumes."""

from __future__ import annotations

import contextlib
import platform
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from geodesics.errors import BadArgument
from gmds.batch.agreement import agreement, write_cycles
from gmds.batch.collection import Collection, Given
from gmds.batch.cycles import Consistency
from gmds.batch.existing_maps import Expected, pair_record
from gmds.batch.lock import cleared, only_run
from gmds.batch.manifest import Manifest, event, write_summary
from gmds.batch.pair_choice import Choice, Pairs
from gmds.batch.records import WITHOUT_MAP, Batch, Failure, PairRecord, ShapeRecord
from gmds.batch.starting import end_if_starting
from gmds.batch.store import Store
from gmds.batch.tasks import PairJob, ShapeJob, match_pair, measure_shape
from gmds.batch.workers import local_client, outcomes
from gmds.matching.pipeline import SAMPLES
from gmds.mds.losses import LeastSquares
from gmds.provenance import is_lasting, method_in_words, versions
from gmds.suggestions import check_keys

Progress = Callable[[str, float], None]

OPTIONS = ("distance", "loss", "n_samples", "orientation", "parts", "rng")
MEASURING, CYCLES = 0.1, 0.02  # shares of the bar of progress, about those of the time; set by hand


def match_collection(
    shapes: Given,
    output: str | Path,
    *,
    pairs: Choice | Pairs | None = None,
    timeout: float | None = None,
    client: Any = None,
    progress: Progress | None = None,
    **options: Any,
) -> Batch:
    """Match many pairs of shapes, on all processors or on a cluster, and keep the maps in a folder.

    Each shape is measured once and kept. Maps that are there and whole, of these meshes, parameters and version, are
    not made again, so a run that was stopped goes on. What fails is told in the records, with a code, and the rest goes
    on; a pair during which three workers died is given up.

    Parameters
    ----------
    shapes : folder, file, sequence of paths, or mapping
        A folder of meshes, a list of pairs `A,B` in a file, paths, or names with their meshes or paths.
    output : path
        The folder of the maps. Workers must see it under the same path.
    pairs : function or pairs of str, optional
        Which to match: `gmds.batch.all_pairs` unless a list says so; or `consecutive`, `with_template(name)`,
        `both_ways(...)` of these.
    timeout : float, optional
        Seconds that a pair may take.
    client : optional
        A `distributed.Client`, or what `gmds.batch.local_client(workers)` or `remote_client(address)` returns; all
        processors of this machine by default (a script then needs `if __name__ == "__main__":`).
    progress : function, optional
        Told what is being done, and how much of it all is done, from 0 to 1.
    **options
        Those of `match`: distance, loss, n_samples, orientation, parts, rng.

    Returns
    -------
    Batch
        A record of every shape and of every pair, and whether the maps agree around triangles of shapes.

    Raises
    ------
    FolderInUse
        E503: one run at a time works in a folder.
    FormatError, ValueError, OSError
        When there is nothing to match.
    MissingExtra
        E602, without dask.
    WorkersNotStarted
        E506, when the processes of this machine die as they start.

    See Also
    --------
    match : One pair.

    Examples
    --------
    >>> import gmds, tempfile
    >>> from gmds.shapes import quadruped
    >>> shapes = {"standing": quadruped(n_vertices=200), "walking": quadruped("walk", n_vertices=200)}
    >>> if __name__ == "__main__":  # as other processes take part
    ...     with tempfile.TemporaryDirectory() as folder:
    ...         batch = gmds.match_collection(shapes, folder)
    ...     print([pair.name for pair in batch.pairs], len(batch.failed))
    ['standing__walking'] 0
    """
    end_if_starting()
    check_keys(options, OPTIONS, "match_collection()")
    if not is_lasting(options.get("distance")):
        raise BadArgument("the distance needs a name that lasts: a function of a module, or functools.partial of one")
    collection = Collection.of(shapes, pairs)
    folder = Path(output).absolute()
    (folder / "pairs").mkdir(parents=True, exist_ok=True)
    (folder / "shapes").mkdir(exist_ok=True)
    with only_run(folder), contextlib.ExitStack() as stack:
        if not hasattr(client, "submit"):
            client = stack.enter_context(client or local_client())
        for kept in ("pairs", "shapes"):
            stack.enter_context(cleared(folder / kept))
        run = _Run(collection, folder, options, timeout, progress or (lambda stage, fraction: None))
        stack.callback(run.manifest.close)
        stack.callback(run.summarise)
        run.work(client)
        run.agree()
        return run.result()


@dataclass(eq=False)
class _Run:
    """A run on its way: records fill up as workers report."""

    collection: Collection
    folder: Path
    options: Mapping[str, Any]
    timeout: float | None
    progress: Progress
    shapes: dict[str, ShapeRecord] = field(default_factory=dict)
    pairs: dict[tuple[str, str], PairRecord] = field(default_factory=dict)
    consistency: Consistency = field(default_factory=lambda: Consistency(()))

    def __post_init__(self) -> None:
        self.manifest = Manifest(self.folder / "manifest.jsonl")
        self.parameters = {
            **method_in_words(self.options.get("distance"), self.options.get("loss") or LeastSquares()),
            "orientation": self.options.get("orientation", "preserve"),
            "parts": self.options.get("parts", "auto"),
            "rng": self.options.get("rng", 0),
        }
        self.store = Store(self.folder / "shapes", whole=self.options.get("distance") is not None)

    def work(self, client: Any) -> None:
        """Measure what is to be measured, match what is to be matched."""
        told = {"parameters": self.parameters | {"n_samples": self.options.get("n_samples")}, "versions": versions()}
        self.manifest.tell("run", {**told, "host": platform.node(), "pairs": len(self.collection.pairs)})
        mirrored = self.parameters["orientation"] in ("reverse", "any")
        jobs = (ShapeJob(shape, self.store, mirrored) for shape in self.collection.shapes.values())
        for shape_job, record in outcomes(client, measure_shape, jobs):
            name = shape_job.shape.name
            self.shapes[name] = ShapeRecord(name, failure=record) if isinstance(record, Failure) else record
            self.manifest.tell("shape", {"origin": shape_job.shape.place, **event(self.shapes[name])})
            done = "measured" if self.shapes[name].failure is None else "cannot use"
            self.progress(f"{done} {name}", MEASURING * len(self.shapes) / len(self.collection.shapes))
        for pair_job, found in outcomes(client, match_pair, self._missing()):
            names = pair_job.source.name, pair_job.target.name
            self._add(PairRecord(*names, "failed", failure=found) if isinstance(found, Failure) else found)

    def _missing(self) -> Iterator[PairJob]:
        """Jobs for the pairs whose maps are not there; the others are recorded on the way."""
        for source, target in self.collection.pairs:
            ours, theirs = self.shapes[source], self.shapes[target]
            broken = next((shape for shape in (ours, theirs) if shape.failure is not None), None)
            if broken is not None and broken.failure is not None:
                failure = Failure(broken.failure.code, f"{broken.name}: {broken.failure.reason}")
                self._add(PairRecord(source, target, "failed", failure=failure))
                continue
            path, expected = self.folder / "pairs" / f"{source}__{target}.npz", self._expected(ours, theirs)
            found = pair_record(path, source, target, expected)
            if found is None:
                yield PairJob(ours, theirs, self.store, path, expected, self.options, self.timeout)
            else:
                self._add(found)

    def _expected(self, source: ShapeRecord, target: ShapeRecord) -> Expected:
        count = self.options.get("n_samples")
        parameters = {**self.parameters, "n_samples": min(SAMPLES, source.usable) if count is None else count}
        meshes = {"source": {"sha256": source.sha256}, "target": {"sha256": target.sha256}}
        return Expected({"parameters": parameters, "versions": {"gmds": versions()["gmds"]}, **meshes})

    def _add(self, record: PairRecord) -> None:
        self.pairs[record.source, record.target] = record
        self.manifest.tell("pair", event(record))
        share = len(self.pairs) / len(self.collection.pairs)
        done = f"{len(self.pairs)} of {len(self.collection.pairs)} pairs"
        told = f"{done}, {record.source} -> {record.target}: {record.status}{', as before' if record.kept else ''}"
        self.progress(told, MEASURING + (1 - MEASURING - CYCLES) * share)

    def result(self) -> Batch:
        """How things stand."""
        rows = tuple(self.pairs.get(pair) or PairRecord(*pair) for pair in self.collection.pairs)
        return Batch(self.folder, dict(self.shapes), rows, self.consistency)

    def agree(self) -> None:
        """Take the maps around triangles of shapes, and blame those that lead astray."""
        done = [pair for pair in self.result().pairs if pair.status not in WITHOUT_MAP]
        report = lambda share: self.progress("going around triangles", 1 - CYCLES + CYCLES * share)  # noqa: E731
        self.consistency = agreement(self.folder / "pairs", self.store, self.shapes, done, report)
        write_cycles(self.folder / "cycles.csv", self.consistency)
        for pair, blame in self.consistency.blame.items():
            self.pairs[pair] = replace(self.pairs[pair], blame=blame)

    def summarise(self) -> None:
        """Write how things stand, also when the run was interrupted."""
        batch = self.result()
        write_summary(self.folder / "summary.csv", batch.pairs)
        self.manifest.tell("end", {"done": len(batch.pairs) - len(batch.failed), "failed": len(batch.failed)})
