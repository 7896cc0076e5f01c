"""Many pairs of a collection of shapes, matched side by side; resumed where it stopped, whatever fails."""

from gmds.batch.pair_choice import all_pairs, both_ways, consecutive, with_template
from gmds.batch.records import Batch, PairRecord, ShapeRecord
from gmds.batch.run import match_collection
from gmds.batch.workers import local_client, quiet, remote_client

__all__ = [
    "Batch",
    "PairRecord",
    "ShapeRecord",
    "all_pairs",
    "both_ways",
    "consecutive",
    "local_client",
    "match_collection",
    "quiet",
    "remote_client",
    "with_template",
]
