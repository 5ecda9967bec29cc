"""The five-link walker in OpenSim Moco: a model of pin joints and torque actuators.

Coordinates are joint angles, so the chain is counted from the ground through the stance leg;
moments are then the same. Heel strike relates rates at both ends of the step by products with
cosines; Moco's goals for such rows are written in C++, so only the variant ``posture`` is posed.
"""

from __future__ import annotations

import five_link as walker
import numpy as np
import opensim as osim
import peer

N = walker.LINKS
POINTS = 3
JOINTS = ("stance_ankle", "stance_knee", "stance_hip", "swing_hip", "swing_knee")
LINKS = ("stance_shank", "stance_thigh", "trunk", "swing_thigh", "swing_shank")
PARENTS = (None, 0, 1, 2, 3)
TORQUE = 10.0
"""Optimal force of the actuators [N m]: a control of one."""
WIDE = (4.0, 40.0, 50.0)
"""Bounds of angles [rad], rates [rad/s] and controls; Moco asks for some, none is active."""


def model() -> osim.Model:
    """The walker in the plane z = 0, x forward, y up, z the axis of all joints."""
    found = osim.Model()
    found.setName("five_link")
    found.set_gravity(osim.Vec3(0, -walker.GRAVITY, 0))
    for i in range(N):
        legs_up = i < 2
        # the first two links stand on their lower joint, the trunk on the hip, and the swing leg
        # hangs from it
        if legs_up:
            centre = walker.LENGTH[i] - walker.COM[i]
        else:
            centre = walker.COM[i] if i == 2 else -walker.COM[i]
        inertia = osim.Inertia(walker.INERTIA[i], walker.INERTIA[i], walker.INERTIA[i])
        body = osim.Body(LINKS[i], walker.MASS[i], osim.Vec3(0, centre, 0), inertia)
        found.addBody(body)
        parent = found.getGround() if i == 0 else found.getBodySet().get(LINKS[PARENTS[i]])
        height = (0.0, walker.LENGTH[0], walker.LENGTH[1], 0.0, -walker.LENGTH[3])[i]
        joint = osim.PinJoint(
            JOINTS[i],
            parent,
            osim.Vec3(0, height, 0),
            osim.Vec3(0),
            body,
            osim.Vec3(0),
            osim.Vec3(0),
        )
        coordinate = joint.updCoordinate(osim.PinJoint.Coord_RotationZ)
        coordinate.setName(f"{JOINTS[i]}_angle")
        coordinate.setRangeMin(-WIDE[0])
        coordinate.setRangeMax(WIDE[0])
        found.addJoint(joint)
        actuator = osim.CoordinateActuator(f"{JOINTS[i]}_angle")
        actuator.setName(f"{JOINTS[i]}_moment")
        actuator.setOptimalForce(TORQUE)
        actuator.setMinControl(-WIDE[2])
        actuator.setMaxControl(WIDE[2])
        found.addForce(actuator)
    found.finalizeConnections()
    return found


def relative(absolute: np.ndarray) -> np.ndarray:
    """Joint angles [rad] or rates from those of the links, (..., 5)."""
    return np.diff(absolute, axis=-1, prepend=0.0)


def build(variant: str, elements: int) -> peer.Solver:
    """The study of one variant on equal elements, as a function of the starting guess."""
    if variant != "posture":
        raise SystemExit("rows that relate both ends by cosines need a goal written in C++")
    study = osim.MocoStudy()
    problem = study.updProblem()
    problem.setModel(model())
    problem.setTimeBounds(0.0, walker.STEP_TIME)
    ends = [[relative(x) for x in state] for state in (walker.START_STATE, walker.END_STATE)]
    for i, name in enumerate(JOINTS):
        for k, kind in enumerate(("value", "speed")):
            problem.setStateInfo(
                f"/jointset/{name}/{name}_angle/{kind}",
                osim.MocoBounds(-WIDE[k], WIDE[k]),
                osim.MocoInitialBounds(float(ends[0][k][i])),
                osim.MocoFinalBounds(float(ends[1][k][i])),
            )
    problem.addGoal(osim.MocoControlGoal("effort", TORQUE**2 / walker.EFFORT_SCALE))
    solver = study.initCasADiSolver()
    solver.set_num_mesh_intervals(elements)
    solver.set_transcription_scheme(f"legendre-gauss-{POINTS}")
    solver.set_interpolate_control_mesh_interior_points(False)
    solver.set_optim_convergence_tolerance(1e-9)
    solver.set_optim_constraint_tolerance(1e-9)
    solver.set_optim_max_iterations(1000)
    solver.set_parallel(0)
    solver.set_verbosity(0)

    def solve(start: walker.Start) -> peer.Outcome:
        solver.setGuess(_guess(solver, start))
        found = study.solve()
        if not found.success():
            found.unseal()
        return peer.Outcome(
            float(found.getObjective()) * walker.EFFORT_SCALE,
            bool(found.success()),
            int(found.getNumIterations()),
            str(found.getStatus()),
        )

    return solve


def _guess(solver: osim.MocoCasADiSolver, start: walker.Start) -> osim.MocoTrajectory:
    """A start on Moco's own grid."""
    guess = solver.createGuess("bounds")
    time = guess.getTime().to_numpy()
    angles, rates = relative(start.angles(time)), relative(start.rates(time))
    moments = start.controls(time)
    for i, name in enumerate(JOINTS):
        state = f"/jointset/{name}/{name}_angle"
        guess.setState(f"{state}/value", osim.Vector.createFromMat(angles[:, i].copy()))
        guess.setState(f"{state}/speed", osim.Vector.createFromMat(rates[:, i].copy()))
        control = osim.Vector.createFromMat(moments[:, i] / TORQUE)
        guess.setControl(f"/forceset/{name}_moment", control)
    return guess


if __name__ == "__main__":
    osim.Logger.setLevelString("off")
    peer.main(
        f"OpenSim {osim.GetVersion()}",
        "{n} elements of " + f"{POINTS} Gauss points",
        build,
        fine=20,
    )
