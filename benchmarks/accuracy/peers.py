"""What others reach on the same pairs, turned and resized in the same way, by the same judge.

    pip install pyfmaps==1.3.1
    GMDS_DATA=... python -m benchmarks.accuracy.peers [--sets scaled,faust_5k] [--half reporting] [--every 8]

pyFM: both meshes at unit area; 150 eigenfunctions; functional map of 20 x 20 from 100 wave-kernel signatures of 128
eigenfunctions with the weights 0.1 of descriptors, 0.001 of the Laplacian, 1 of descriptor multiplication and 1 of the
orientation term; ZoomOut to 120 in steps of 5; nearest vertex. Without the orientation term, and from 30 x 30, it was
worse on four pairs tried (2 TOSCA, 2 scaled); on two FAUST pairs the term changed nothing. Writes peers_<set>.csv and
peers.md to benchmarks/results/, and does not do again what a CSV holds.
"""

from __future__ import annotations

from importlib.metadata import version

from benchmarks.accuracy.halves import DEVELOPMENT
from benchmarks.accuracy.runs import Job, arguments, chosen_pairs, read_rows, run
from benchmarks.accuracy.tables import accuracy, sections
from geodesics import Mesh, SurfacePoints
from gmds.benchmarking.run import Matcher
from gmds.correspondence import Correspondence

FIRST, STEP, STEPS = 20, 5, 20  # ZoomOut from 20 to 120 functions
EIGENFUNCTIONS = 150
WEIGHTS = {"w_descr": 0.1, "w_lap": 1e-3, "w_dcomm": 1.0, "w_orient": 1.0}
ABOUT = """The same pairs, turned and resized in the same way, the same truth points and judge as in accuracy.md. Mean
geodesic error x100, direct unless said. CPU seconds are of one thread, on a shared machine."""
SETTINGS = f"""{EIGENFUNCTIONS} eigenfunctions of each mesh at unit area; functional map of {FIRST} x {FIRST} from 100
wave-kernel signatures of 128 eigenfunctions, weights {" ".join(f"{k}={w:g}" for k, w in WEIGHTS.items())};
ZoomOut to {FIRST + STEPS * STEP} functions in steps of {STEP}; nearest vertex."""


def functional_map(source: Mesh, target: Mesh) -> Correspondence:
    """pyFM's map. Its functional map goes from functions on mesh 1 to mesh 2, its vertex map from mesh 2 to mesh 1."""
    from pyFM.functional import FunctionalMapping  # type: ignore[import-untyped]
    from pyFM.mesh import TriMesh  # type: ignore[import-untyped]

    model = FunctionalMapping(*(TriMesh(mesh.vertices, mesh.faces, normalize=True) for mesh in (target, source)))
    model.preprocess(n_descr=100, descr_type="WKS", k_descr=128, k_process=EIGENFUNCTIONS)
    model.fit(K=(FIRST, FIRST), **WEIGHTS)
    images = model.get_p2p(model.zoomout_refine(nit=STEPS, step=STEP))
    return Correspondence.from_points(source, SurfacePoints.at_vertices(target, images))


PEERS: dict[str, Matcher] = {"pyFM": functional_map}


def peer(name: str) -> Matcher:
    """A peer by its name."""
    return PEERS[name]


def main() -> None:
    """Run, and write the tables."""
    sets = [name for name in DEVELOPMENT if not name.endswith("_reversed")]
    options = arguments(__doc__, sets).parse_args()
    release = f"pyfmaps {version('pyfmaps')}"
    for name in options.sets:
        job = Job(name, chosen_pairs(name, options.half, options.every), list(PEERS), peer)
        run(job, options.output / f"peers_{name}.csv", release, options.workers)
    text = ["# Peers", "", ABOUT, ""]
    for method, settings in {"pyFM": f"{release}: {SETTINGS}"}.items():
        found = {}
        for name in sets:
            rows = read_rows(options.output / f"peers_{name}.csv", release)
            found.update(sections(name, [row for (who, _), row in rows.items() if who == method]))
        text += [f"## {method}", "", settings, "", *accuracy(found, goals={})]
    (options.output / "peers.md").write_text("\n".join(text), encoding="utf-8")
    print("\n".join(text))


if __name__ == "__main__":
    main()
