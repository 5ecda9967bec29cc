"""Mechanics of the nine-link walker: kinematics, two-link foot, dynamics (1), energy."""
