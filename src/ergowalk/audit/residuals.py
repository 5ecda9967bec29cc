"""The residuals of an audit: name, tolerance of an acceptable gait, unit.

The order and the tolerances are those of the contract's table; what it leaves open (instants,
attributes, agreement of stored values with each other) is held to rounding.
"""

from __future__ import annotations

from ergowalk.audit.report import Residual

PER_WEIGHT = "body weight"
PER_WEIGHT_METRE = "body weight x 1 m"

EQUATIONS_OF_MOTION = Residual("equations_of_motion", "equations of motion (1)", 1e-6)
SWING_UNLOADED = Residual("swing_unloaded", "no load on a foot in swing", 1e-6)
VELOCITIES = Residual("velocities", "velocities against positions", 1e-5)
ACCELERATIONS = Residual("accelerations", "accelerations against velocities", 1e-5)
NO_IMPACT = Residual("no_impact", "no jump of positions or velocities", 1e-5)
FEET_FIXED = Residual("feet_fixed", "contact points at rest in their prints", 1e-4, "m")
FEET_ABOVE_GROUND = Residual("feet_above_ground", "no point of a foot below ground", 1e-4, "m")
TOES = Residual("toes", "toes in line with the sole, or bent upwards", 1e-4, "m")
JOINT_ANGLES = Residual("joint_angles", "joint angles against segment angles", 1e-6, "rad")
REACTION_UPWARD = Residual("reaction_upward", "the ground only pushes", 1e-3, PER_WEIGHT)
REACTION_CAP = Residual("vertical_reaction_cap", "R_y below its limit", 1e-3, PER_WEIGHT)
FRICTION = Residual("friction", "R_x inside the friction cone", 1e-3, PER_WEIGHT)
MOMENT_LIMITS = Residual(
    "moment_limits", "joint moments within their limits", 1e-3, PER_WEIGHT_METRE
)
MOMENT_RATE_LIMITS = Residual(
    "moment_rate_limits", "moment rates within their limits", 1e-3, PER_WEIGHT_METRE
)
CENTER_OF_PRESSURE = Residual(
    "center_of_pressure", "centre of pressure inside its interval", 2e-3, "m"
)
CORRIDORS = Residual("corridors", "joint angles inside the stored corridors", 0.1, "deg")
CORRIDORS_AS_ASKED = Residual(
    "corridors_as_asked", "stored corridors against the problem's", 0.1, "deg"
)
PERIODICITY = Residual("periodicity", "periodicity after a stride", 1e-6)
LEG_SYMMETRY = Residual("leg_symmetry", "legs alike half a stride later", 1e-6)
LOAD_SYMMETRY = Residual("load_symmetry", "loads alike half a stride later", 1e-6)
ENERGY = Residual("energy", "energy per metre against the stored powers", 1e-3)
OBJECTIVE = Residual("objective", "objective against the curves", 1e-3)
JOINT_POWER = Residual("joint_power", "joint power against moment times rate (10)", 1e-6)
DEVICE_LAW = Residual("device_law", "moments and angles of devices against their laws", 1e-4)
DEVICE_ENERGY = Residual("device_energy", "energy that devices give over a stride", 1e-3)
DEVICE_IN_PLACE = Residual(
    "device_in_place", "no own moment where a device takes its place", 1e-3, PER_WEIGHT_METRE
)
DESIGN = Residual("design", "free numbers of the design inside their bounds", 1e-9)
WORK_ENERGY = Residual("work_energy", "work against mechanical energy", 1e-3)
MESH = Residual("mesh", "energy per metre against a finer mesh", 1e-2)
TIME_SPAN = Residual("time_span", "time runs from 0 to T", 1e-9, "T")
TIME_STEPS = Residual("time_steps", "longest step of time", (1 + 1e-9) / 400, "T")
SMOOTH_PIECES = Residual("smooth_pieces", "smooth pieces with fewer than five samples", 0.0)
PHASES = Residual("phases", "contact phases at the instants of the rhythm", 1e-6, "T")
RHYTHM_ORDER = Residual("rhythm_order", "order of the rhythm (3)", 1e-6, "T")
RHYTHM_AS_ASKED = Residual("rhythm_as_asked", "rhythm within the bounds of the problem", 1e-6, "T")
STEPS_AS_ASKED = Residual("steps_as_asked", "both steps within the bounds of the problem", 1e-6)
ATTRIBUTES = Residual("attributes", "attributes against the stored problem", 1e-9)
FINITE = Residual("finite", "values that are not numbers", 0.0)
