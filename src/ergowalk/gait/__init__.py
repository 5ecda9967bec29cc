"""Gait: contact phases, rhythm and the symmetry of the legs."""
