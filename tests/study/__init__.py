"""Sweeps: cases, plan, store, running, faults."""
