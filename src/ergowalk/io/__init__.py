"""A gait for other software: tables, OpenSim, motion capture, MuJoCo."""

from ergowalk.io.formats import FORMATS, Format, format_of
from ergowalk.io.mjcf import body_mjcf
from ergowalk.io.sampling import RATE, STRIDES, Samples

__all__ = ["FORMATS", "RATE", "STRIDES", "Format", "Samples", "body_mjcf", "format_of"]
