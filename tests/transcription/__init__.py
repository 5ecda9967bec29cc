"""Collocation on problems with known answers, and what it makes of walking."""
