"""gmds signatures: what every vertex of a mesh looks like to heat and waves."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from gmds.cli.fields import FILE, draw, metric_option, output_option, picture_option, write_field
from gmds.cli.group import Command
from gmds.cli.output import emit, json_option, progress_bar

if TYPE_CHECKING:
    from geodesics import Spectrum
    from geodesics.arrays import Floats

KINDS = ("hks", "scaled-hks", "si-hks", "wks")
TIMES, ENERGIES = 16, 100  # how many a signature has; of WKS as in the code of its authors, of HKS set by hand
PICTURED = 3  # columns that the picture shows; set by hand


def _numbers(_ctx: click.Context, _param: click.Parameter, given: str | None) -> list[float] | None:
    if given is None:
        return None
    try:
        return [float(word) for word in given.split(",")]
    except ValueError:
        raise click.BadParameter(f"{given!r} must be numbers with commas between them") from None


@click.command(cls=Command, short_help="Compute heat and wave kernel signatures.")
@click.argument("mesh", type=FILE)
@click.option("--kind", type=click.Choice(KINDS), default="hks", show_default=True, help="Which signature.")
@click.option("--times", callback=_numbers, metavar="T,T,...", help="Times of heat, in units of the surface's area.")
@click.option("--energies", type=click.IntRange(min=2), help=f"How many energies of waves.  [default: {ENERGIES}]")
@metric_option
@output_option
@picture_option
@json_option
def command(
    mesh: Path,
    kind: str,
    times: list[float] | None,
    energies: int | None,
    metric: str,
    output: Path,
    picture: Path | None,
    as_json: bool,
) -> None:
    """Compute a signature of every vertex of MESH from the eigenfunctions of its Laplacian.

    \b
      hks         heat kernel signature: heat that stays, at each time
      scaled-hks  the same, over its integral on the surface
      si-hks      scale-invariant heat kernel signature, at 6 frequencies; times must grow by a constant factor
      wks         wave kernel signature, at each energy

    \b
      gmds signatures dog.ply -o signatures.npz --picture signatures.png
      gmds signatures dog.ply --kind scaled-hks --times 0.01,0.1 --metric scale-invariant -o signatures.csv

    Without --times there are 16 (si-hks: 64), over the range that the eigenfunctions resolve. A .npz holds `signature`,
    a row for every vertex, and `times` for hks and scaled-hks; a .csv has a line for every vertex. The picture shows
    the first, the middle and the last column, each in the range of its own. Metrics are those of `gmds match --metric`.
    """
    import time

    from geodesics import read_mesh
    from gmds.cli.choices import chosen_spectrum

    if times is not None and kind == "wks":
        raise click.UsageError("--times are of heat; wks has --energies")
    if energies is not None and kind != "wks":
        raise click.UsageError(f"--energies are of wks; {kind} has --times")
    surface = read_mesh(mesh)
    started = time.process_time()
    with progress_bar("signatures"):
        spectrum = chosen_spectrum(metric, surface)
        arrays, names = _signature(kind, spectrum, times, energies or ENERGIES)
    signature = arrays["signature"]
    write_field(output, arrays, dict(zip(names, signature.T, strict=True)))
    result = {
        "file": str(output),
        "kind": kind,
        "vertices": surface.n_vertices,
        "columns": len(names),
        "eigenfunctions": len(spectrum.eigenvalues),
        "cpu_seconds": time.process_time() - started,
    }
    emit(result, as_json)
    shown = sorted({i * (len(names) - 1) // (PICTURED - 1) for i in range(PICTURED)})
    panels = [(f"{kind}, {names[i]}", surface, _in_own_range(signature[:, i])) for i in shown]
    draw(picture, panels, name=mesh, label="from the 2nd to the 98th percentile of each")


def _signature(
    kind: str, spectrum: Spectrum, times: list[float] | None, energies: int
) -> tuple[dict[str, Floats], list[str]]:
    """The arrays to write, the signature (n, columns) first, and the names of its columns."""
    import numpy as np

    from geodesics import signatures, wave_kernel_signature

    if kind == "wks":
        signature = wave_kernel_signature(spectrum, energies)
        return {"signature": signature}, [f"energy_{i}" for i in range(energies)]
    if kind == "si-hks":
        signature = signatures.scale_invariant_heat_kernel_signature(spectrum, times)
        return {"signature": signature}, [f"frequency_{i}" for i in range(signature.shape[1])]
    at = signatures.resolved_times(spectrum, TIMES) if times is None else np.array(times)
    compute = signatures.heat_kernel_signature if kind == "hks" else signatures.scaled_heat_kernel_signature
    return {"signature": compute(spectrum, at), "times": at}, [f"t={t:.6g}" for t in at]


def _in_own_range(values: Floats) -> Floats:
    """Values from 0 to 1 between their quantiles of 2 and 98 %, so that few extreme vertices do not hide the rest."""
    import numpy as np

    low, high = np.quantile(values, [0.02, 0.98])
    clipped: Floats = ((values - low) / (high - low if high > low else 1.0)).clip(0, 1)
    return clipped
