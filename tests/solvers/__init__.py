"""Solvers on classical problems."""
