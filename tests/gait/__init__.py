"""Tests of rhythm, phases and footprints."""
