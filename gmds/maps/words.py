"""The words by which a map is judged, each defined once: help, documentation and the page quote them from here."""

from __future__ import annotations

WORDS = {
    "status": (
        "How far a map as a whole can be trusted, in one word: GOOD, INCOMPLETE, AMBIGUOUS, POOR, or UNRATED where "
        "nobody has judged it."
    ),
    "confidence": (
        "The probability, from 0 to 1, that a point is sent to within 0.05 root areas of the target of where it "
        "belongs; 0 where it has no counterpart."
    ),
    "distortion": "By what share lengths around a point change, from 0 for none.",
    "growth": (
        "The natural logarithm of how much longer things around a point became from source to target, beside the "
        "whole: 0.69 is twice as long, -0.69 half as long."
    ),
    "stress": (
        "The mean difference between distances on the source and those between the same points on the target, over the "
        "mean distance: small is good."
    ),
    "orientation": (
        "From -1 to 1, the share of the area of the image that keeps the orientation of the surface, minus the share "
        "that reverses it: near -1 the map is a mirror image."
    ),
    "error": (
        "How far a point is sent from its true place, along the target, over the square root of the area of the "
        "target; known only where the truth is."
    ),
}
