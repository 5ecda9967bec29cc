"""Transcription: optimal control problems in phases become nonlinear programmes."""
