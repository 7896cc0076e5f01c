"""Finding shapes that are like a shape, by bags of features (Table 1).

    Mesh -> mended -> Spectrum -> signature of every vertex -> words -> bag, one vector a shape -> ranking

After ShapeGoogle (Bronstein, Bronstein, Guibas, Ovsjanikov 2011), in any metric.
"""

from gmds.retrieval.bags import BagOfFeatures, bag, learned, pair_bag
from gmds.retrieval.descriptors import (
    DEFAULT,
    INVARIANT,
    INVARIANT_FREQUENCIES,
    REGULAR,
    REGULAR_FREQUENCIES,
    Described,
    Descriptor,
    signatures_of,
)
from gmds.retrieval.mending import mended
from gmds.retrieval.ranking import Ranking, bag_distances, ranking, retrieve
from gmds.retrieval.scores import RetrievalScores, retrieval_scores
from gmds.retrieval.vocabulary import Vocabulary, learn_vocabulary

__all__ = [
    "DEFAULT",
    "INVARIANT",
    "INVARIANT_FREQUENCIES",
    "REGULAR",
    "REGULAR_FREQUENCIES",
    "BagOfFeatures",
    "Described",
    "Descriptor",
    "Ranking",
    "RetrievalScores",
    "Vocabulary",
    "bag",
    "bag_distances",
    "learn_vocabulary",
    "learned",
    "mended",
    "pair_bag",
    "ranking",
    "retrieval_scores",
    "retrieve",
    "signatures_of",
]
