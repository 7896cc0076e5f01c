"""How confident a map can be: a model fitted to half of many maps of known truth, judged on the rest."""
