"""Many pairs of a collection of shapes, matched side by side; resumed where it stopped, whatever fails."""

from gmds.batch.engine import local_client, quiet, remote_client
from gmds.batch.pairs import all_pairs, both_ways, consecutive, with_template
from gmds.batch.records import PairRecord, ShapeRecord
from gmds.batch.run import Batch, match_collection

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
