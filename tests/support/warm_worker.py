"""Imported by the process that workers are forked from: a match, so that kernels are loaded."""

import os

from generated_shapes import bumpy_sphere

import gmds
import gmds.batch.tasks

os.environ["GMDS_THREADS"] = "1"  # threads do not survive a fork; workers have one anyway
gmds.match(bumpy_sphere(1), bumpy_sphere(1, seed=1))
