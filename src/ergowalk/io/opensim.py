"""A gait for OpenSim: coordinates, external loads and moments as in its model gait10dof18musc.

The right leg is leg 1. x is forward, y up, z to the right. Coordinates and moments are positive
counter-clockwise seen from the right (about z): hip flexion, knee EXTENSION, ankle dorsiflexion,
pelvis and trunk leaning back. Trunk and pelvis are one body here: the lumbar angle is zero.
"""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ergowalk import __version__
from ergowalk.io.sampling import RATE, STRIDES, Samples
from ergowalk.io.storage import storage_text

Array = NDArray[np.float64]

SIDES = {"r": 1, "l": 2}
"""The leg of each side."""

HIP_IN_PELVIS = (-0.0707, -0.0661)
"""Place of the hip in the pelvis frame of gait10dof18musc [m]: ``pelvis_tx`` and ``pelvis_ty``
are those of that frame, so that the hip of the model is the hip of the walker."""

REACTIONS_FILE = "reactions.mot"
"""Name of the file that :func:`external_loads` refers to."""

_SIGNS = (
    "Right leg = leg 1. Positive: hip flexion, knee extension, ankle dorsiflexion, leaning back."
)


def angles(dataset: xr.Dataset, rate: float = RATE, strides: int = STRIDES) -> str:
    """Coordinates as a motion file (.mot), angles in degrees, lengths in m.

    Parameters
    ----------
    dataset : xarray.Dataset
        A gait in the format of ``gait.nc``.
    rate, strides
        As for :class:`ergowalk.io.Samples`.

    Raises
    ------
    GaitFileError, InputError
        As :class:`ergowalk.io.Samples`.
    """
    samples = Samples(dataset, rate, strides)
    trunk, hip = samples.trunk(), samples.hip()
    x, y = HIP_IN_PELVIS
    columns = {
        "time": samples.time,
        "pelvis_tilt": np.degrees(trunk),
        "pelvis_tx": hip[:, 0] - (x * np.cos(trunk) - y * np.sin(trunk)),
        "pelvis_ty": hip[:, 1] - (x * np.sin(trunk) + y * np.cos(trunk)),
    }
    for side, leg in SIDES.items():
        thigh, shank, foot = (samples.segment(leg, s) for s in ("thigh", "shank", "foot"))
        flat = np.pi / 2 - samples.body.leg(leg - 1).foot_angle
        columns[f"hip_flexion_{side}"] = np.degrees(thigh - trunk)
        columns[f"knee_angle_{side}"] = np.degrees(shank - thigh)
        columns[f"ankle_angle_{side}"] = np.degrees(foot - shank - flat)
    columns["lumbar_extension"] = np.zeros_like(samples.time)
    remarks = ("", "Units are S.I. units (second, meters, Newtons, ...)", "Angles are in degrees.")
    return storage_text("Coordinates", columns, True, (*remarks, _origin(dataset), ""))


def reactions(dataset: xr.Dataset, rate: float = RATE, strides: int = STRIDES) -> str:
    """Ground reactions as external loads (.mot): force [N], place [m], torque [N m].

    The names of the columns are those of the sample that comes with gait10dof18musc: nothing
    before the right foot's, ``1_`` before the left's. Parameters and errors as :func:`angles`.
    """
    samples = Samples(dataset, rate, strides)
    zero = np.zeros_like(samples.time)
    columns = {"time": samples.time}
    for leg, prefix in ((1, ""), (2, "1_")):
        force = samples.reaction(leg)
        pressure = (samples.pressure(leg), zero, zero)
        for axis, value in zip("xyz", (force[:, 0], force[:, 1], zero), strict=True):
            columns[f"{prefix}ground_force_v{axis}"] = value
        for axis, value in zip("xyz", pressure, strict=True):
            columns[f"{prefix}ground_force_p{axis}"] = value
    for prefix in ("", "1_"):
        columns |= {f"{prefix}ground_torque_{axis}": zero for axis in "xyz"}
    return storage_text(REACTIONS_FILE, columns, True, (_origin(dataset),))


def moments(dataset: xr.Dataset, rate: float = RATE, strides: int = STRIDES) -> str:
    """Joint moments [N m] as OpenSim's inverse dynamics writes them (.sto).

    A moment acts along its coordinate: q, u and p of the paper, as they are. The forces and the
    moment on the pelvis that inverse dynamics would need are zero: the motion obeys (1).
    Parameters and errors as :func:`angles`.
    """
    samples = Samples(dataset, rate, strides)
    zero = np.zeros_like(samples.time)
    columns = {"time": samples.time}
    columns |= dict.fromkeys(("pelvis_tilt_moment", "pelvis_tx_force", "pelvis_ty_force"), zero)
    for side, leg in SIDES.items():
        for joint, name in (
            ("hip", "hip_flexion"),
            ("knee", "knee_angle"),
            ("ankle", "ankle_angle"),
        ):
            columns[f"{name}_{side}_moment"] = samples.moment(leg, joint)
    remarks = (_origin(dataset), _SIGNS)
    return storage_text("Inverse Dynamics Generalized Forces", columns, False, remarks)


def external_loads() -> str:
    """OpenSim's setup of the external loads (.xml): which columns act on which foot."""
    loads = "".join(
        f"""
			<ExternalForce name="{side}">
				<isDisabled>false</isDisabled>
				<applied_to_body>calcn_{side}</applied_to_body>
				<force_expressed_in_body>ground</force_expressed_in_body>
				<point_expressed_in_body>ground</point_expressed_in_body>
				<force_identifier>{prefix}ground_force_v</force_identifier>
				<point_identifier>{prefix}ground_force_p</point_identifier>
				<torque_identifier>{prefix}ground_torque_</torque_identifier>
				<data_source_name>{REACTIONS_FILE}</data_source_name>
			</ExternalForce>"""
        for side, prefix in (("r", ""), ("l", "1_"))
    )
    return f"""<?xml version="1.0" encoding="UTF-8" ?>
<OpenSimDocument Version="30000">
	<ExternalLoads name="externalloads">
		<objects>{loads}
		</objects>
		<groups />
		<datafile>{REACTIONS_FILE}</datafile>
	</ExternalLoads>
</OpenSimDocument>
"""


def _origin(dataset: xr.Dataset) -> str:
    title = " ".join(str(dataset.attrs.get("title", "gait")).split())
    return f"{title}, written by ergowalk {__version__}."
