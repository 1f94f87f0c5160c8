"""Soundness: no pose that an independent search finds may exceed a bound that nullpose states."""
