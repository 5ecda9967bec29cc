"""Tests of the mechanics, named after the laws they check."""
