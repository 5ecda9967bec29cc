"""Recorded walks: readers for C3D, TRC, MOT, STO and tables."""

from ergowalk.recording.reading import read_recording
from ergowalk.recording.recording import UNITS, Plate, Recording

__all__ = ["UNITS", "Plate", "Recording", "read_recording"]
