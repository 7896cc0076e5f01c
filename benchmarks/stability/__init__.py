"""What must not change: between triangulations, runs, threads, versions."""
