"""Tests of measured walks."""
