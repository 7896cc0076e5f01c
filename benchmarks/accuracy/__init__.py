"""Errors against known truth: ours, peers, ablations, on the pairs of either half."""
