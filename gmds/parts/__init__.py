"""Where a part lies on a whole, or two parts overlap: rigid alignments, extremities, trilateration, local stress."""
