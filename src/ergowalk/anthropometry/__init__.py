"""Masses, lengths and inertias of a person from height and mass, after published tables."""

from ergowalk.anthropometry.person import MASSES, MEASURED, Person
from ergowalk.anthropometry.tables import TABLES, Segment, length_fractions, segments

__all__ = ["MASSES", "MEASURED", "TABLES", "Person", "Segment", "length_fractions", "segments"]
