"""Measured walks: from recorded markers and forces to curves of strides and a problem to solve."""
