"""Descriptors of vertices for bags of features: a metric, and a heat-kernel signature in it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from geodesics import (
    Mesh,
    Metric,
    Spectrum,
    eigenpairs,
    embedded,
    heat_kernel_signature,
    scale_invariant,
    scale_invariant_heat_kernel_signature,
)
from geodesics.arrays import Floats
from gmds.retrieval.mending import mended

# all chosen on the classes DEVELOPMENT of examples/paper/table1_retrieval.py
EIGENPAIRS = 120
HEAT_TIMES = np.geomspace(0.002, 0.1, 12)  # in units of the area
LOG_TIMES = np.geomspace(0.001, 1, 64)  # in units of the area
FREQUENCIES = 6  # of the logarithm of time, the lowest ones


@dataclass(frozen=True)
class Descriptor:
    """A signature (n, k) of the eigenpairs in a metric; `signature` and `metric` are any functions of that kind."""

    name: str
    metric: Callable[[Mesh], Metric]
    signature: Callable[[Spectrum], Floats]


@dataclass(frozen=True, eq=False)
class Described:
    """The signature (n, k) of every vertex and the area (n,) that it stands for, in one metric."""

    values: Floats
    mass: Floats


def signatures_of(mesh: Mesh, descriptors: Sequence[Descriptor], *, mend: bool = True) -> tuple[Described, ...]:
    """Each descriptor of a mesh, which is `mended` first unless that was done; one eigenproblem for each metric.

    Raises `MeshError` or `EigensolverFailed` where a metric cannot be measured.
    """
    whole = mended(mesh) if mend else mesh
    metrics = dict.fromkeys(descriptor.metric for descriptor in descriptors)
    spectra = {metric: eigenpairs(metric(whole), EIGENPAIRS) for metric in metrics}
    return tuple(Described(d.signature(spectra[d.metric]), spectra[d.metric].mass) for d in descriptors)


def log_heat(spectrum: Spectrum) -> Floats:
    """log(area HKS(s, t)) of (5.1) at `HEAT_TIMES`: (n, number of times), no unit."""
    result = np.zeros((len(spectrum.mass), len(HEAT_TIMES)))
    used = spectrum.mass > 0
    result[used] = np.log(spectrum.mass.sum() * heat_kernel_signature(spectrum, HEAT_TIMES)[used])
    return result


def heat_frequencies(spectrum: Spectrum) -> Floats:
    """The scale-invariant heat-kernel signature (footnote 1) over the times LOG_TIMES: (n, FREQUENCIES), no unit."""
    return scale_invariant_heat_kernel_signature(spectrum, LOG_TIMES, FREQUENCIES)


REGULAR = Descriptor("HKS", embedded, log_heat)
REGULAR_FREQUENCIES = Descriptor("SI-HKS", embedded, heat_frequencies)
INVARIANT = Descriptor("invariant HKS", scale_invariant, log_heat)
INVARIANT_FREQUENCIES = Descriptor("invariant SI-HKS", scale_invariant, heat_frequencies)

# the regular metric distinguishes similar shapes, the invariant one finds them after their parts were scaled
DEFAULT = (REGULAR, INVARIANT)
