"""The files that the documentation speaks of, made from code: two animals, and what belongs to them"""
