"""Solvers: a nonlinear programme and a starting point become a point. Nothing here walks."""
