"""Sec. 5: samples placed on the target so that distances agree; problem, solver, losses."""
