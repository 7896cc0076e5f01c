"""What holds for the whole run: few threads, and random cases that are the same every time."""

import os

from hypothesis import HealthCheck, settings

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # small matrices everywhere, and machines that are shared

# a slow machine fails no test, and neither does a case that is new today (--hypothesis-profile=default draws others)
settings.register_profile("same", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("same")
