"""Tests of the readers of recorded walks."""
