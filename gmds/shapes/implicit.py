"""Smooth bodies as the zero set of a blended signed distance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from geodesics.arrays import Floats

Point = tuple[float, float, float]


class Part(Protocol):
    """A piece of a body: it belongs to a joint and knows its signed distance."""

    @property
    def joint(self) -> str:
        """The name of the joint that moves this piece."""

    def distance(self, x: Floats) -> Floats:
        """Signed distance (p,) of points (p, 3), negative inside."""

    def box(self) -> tuple[Floats, Floats]:
        """Lower and upper corner (3,) of an axis-aligned box around the piece."""


@dataclass(frozen=True)
class Cone:
    """The convex hull of two balls: a limb from `start` to `end` with radii `r0` and `r1`."""

    joint: str
    start: Point
    end: Point
    r0: float
    r1: float

    def distance(self, x: Floats) -> Floats:
        """Exact signed distance (p,) of points (p, 3) to the hull of the two balls."""
        a, axis = np.array(self.start), np.subtract(self.end, self.start)
        length = np.linalg.norm(axis)
        along = (x - a) @ (axis / length)
        across = np.sqrt(np.maximum(((x - a) ** 2).sum(1) - along**2, 0))
        sine = (self.r0 - self.r1) / length
        foot = np.clip((along + across * sine / np.sqrt(1 - sine**2)) / length, 0, 1)
        return np.hypot(along - foot * length, across) - (self.r0 + foot * (self.r1 - self.r0))

    def box(self) -> tuple[Floats, Floats]:
        """Lower and upper corner (3,) of an axis-aligned box around the piece."""
        ends, radii = np.array([self.start, self.end]), np.array([[self.r0], [self.r1]])
        return (ends - radii).min(0), (ends + radii).max(0)


@dataclass(frozen=True)
class Ellipsoid:
    """An ellipsoid at `centre` with half axes `size` along the rows of a rotation given by `long` and `flat`.

    `long` is the direction of the first half axis, `flat` (made orthogonal to it) that of the third.
    """

    joint: str
    centre: Point
    size: Point
    long: Point = (1, 0, 0)
    flat: Point = (0, 0, 1)

    def _axes(self) -> Floats:
        first = np.array(self.long) / np.linalg.norm(self.long)
        third = self.flat - (self.flat @ first) * first
        third /= np.linalg.norm(third)
        return np.stack([first, np.cross(third, first), third])

    def distance(self, x: Floats) -> Floats:
        """Signed distance (p,) of points (p, 3), to first order near the surface."""
        local = (x - np.array(self.centre)) @ self._axes().T
        k0 = np.linalg.norm(local / self.size, axis=1)
        k1 = np.linalg.norm(local / np.square(self.size), axis=1)
        return k0 * (k0 - 1) / np.maximum(k1, 1e-12)

    def box(self) -> tuple[Floats, Floats]:
        """Lower and upper corner (3,) of an axis-aligned box around the piece."""
        half = np.linalg.norm(self._axes() * np.array(self.size)[:, None], axis=0)
        return np.array(self.centre) - half, np.array(self.centre) + half


def distances(parts: Sequence[Part], x: Floats) -> Floats:
    """Signed distance to each part, shape (parts, p)."""
    return np.stack([part.distance(x) for part in parts])


def blend(parts: Sequence[Part], x: Floats, width: float) -> Floats:
    """The smooth union -k log sum exp(-d_i / k), shape (p,); it does not depend on the order of the parts."""
    d = distances(parts, x)
    least = d.min(axis=0)
    return least - width * np.log(np.exp((least - d) / width).sum(axis=0))


def project(parts: Sequence[Part], x: Floats, width: float, steps: int = 4) -> Floats:
    """Points (p, 3) near the surface moved onto it by Newton steps along the gradient."""
    h = 1e-4 * width
    for _ in range(steps):
        value = blend(parts, x, width)
        slopes = [blend(parts, x + h * e, width) - blend(parts, x - h * e, width) for e in np.eye(3)]
        gradient = np.stack(slopes, axis=1) / (2 * h)
        step = (value / np.maximum((gradient**2).sum(1), 0.04))[:, None] * gradient
        limit = width / np.maximum(np.linalg.norm(step, axis=1, keepdims=True), width)
        x = x - step * limit
    return x
