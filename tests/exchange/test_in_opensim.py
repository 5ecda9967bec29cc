"""OpenSim itself reads the files; skipped where its Python package is not installed.

A nine-link walker is built in OpenSim with the names of gait10dof18musc, and its inverse dynamics
run on the exported coordinates and ground reactions. The moments that it finds are the exported
ones: names, units, signs and places of all three files fit together.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ergowalk.io import FORMATS, Samples
from ergowalk.io.opensim import HIP_IN_PELVIS
from ergowalk.io.rigid import rigid

osim = pytest.importorskip("opensim", reason="the package opensim is not installed")


@pytest.fixture(scope="module")
def folder(export, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """All files of an export at 1 kHz."""
    place: Path = tmp_path_factory.mktemp("opensim")
    for f in FORMATS.values():
        (place / f.file).write_text(export.text(f.name, 1000.0))
    return place


def walker(body: Any) -> Any:
    """The walker as an OpenSim model, the foot a point at the ankle."""
    model, origin = osim.Model(), osim.Vec3(0)
    model.setGravity(osim.Vec3(0, -body.gravity_m_s2, 0))
    parts, (hip_x, hip_y) = rigid(body), HIP_IN_PELVIS

    def segment(name: str, mass: float, place: tuple[float, float], inertia: float) -> Any:
        made = osim.Body(name, mass, osim.Vec3(*place, 0), osim.Inertia(inertia, inertia, inertia))
        model.addBody(made)
        return made

    trunk = parts.trunk
    pelvis = segment("pelvis", trunk.mass, (hip_x, hip_y + trunk.com), trunk.central_inertia)
    root = osim.PlanarJoint("root", model.getGround(), origin, origin, pelvis, origin, origin)
    for i, name in enumerate(("pelvis_tilt", "pelvis_tx", "pelvis_ty")):
        root.upd_coordinates(i).setName(name)
    model.addJoint(root)
    for i, side in enumerate("rl"):
        leg, p = parts.legs[i], body.leg(i)
        femur = segment(
            f"femur_{side}", leg.thigh.mass, (0, -leg.thigh.com), leg.thigh.central_inertia
        )
        tibia = segment(
            f"tibia_{side}", leg.shank.mass, (0, -leg.shank.com), leg.shank.central_inertia
        )
        foot = segment(f"calcn_{side}", leg.foot_mass, (0, 0), 1e-8)
        for name, parent, place, child in (
            ("hip_flexion", pelvis, (hip_x, hip_y), femur),
            ("knee_angle", femur, (0, -p.thigh_length), tibia),
            ("ankle_angle", tibia, (0, -p.shank_length), foot),
        ):
            joint = osim.PinJoint(
                f"{name}_{side}_pin", parent, osim.Vec3(*place, 0), origin, child, origin, origin
            )
            joint.updCoordinate().setName(f"{name}_{side}")
            model.addJoint(joint)
    model.finalizeConnections()
    return model


def columns(file: Path) -> dict[str, Any]:
    table = osim.TimeSeriesTable(str(file))
    return {name: table.getDependentColumn(name).to_numpy() for name in table.getColumnLabels()}


def test_inverse_dynamics_of_opensim_gives_the_exported_moments(export, folder: Path) -> None:
    """Half of the samples within 0.02 N m and four of five within 0.1 N m, of up to 200 N m; the
    pelvis needs no force, to 0.2 N and 0.5 N of 718 N. (The others stand where accelerations jump:
    OpenSim's splines ring there.)"""
    model_file = folder / "walker.osim"
    walker(Samples(export.gait).body).printToXML(str(model_file))
    model = osim.Model(str(model_file))
    model.initSystem()
    tool = osim.InverseDynamicsTool()
    tool.setModel(model)
    tool.setCoordinatesFileName(str(folder / "angles.mot"))
    tool.setExternalLoadsFileName(str(folder / "external_loads.xml"))
    tool.setLowpassCutoffFrequency(-1)
    tool.setStartTime(0.0)
    tool.setEndTime(1.14)
    tool.setResultsDir(str(folder))
    tool.setOutputGenForceFileName("found.sto")
    assert tool.run()
    found, written = columns(folder / "found.sto"), columns(folder / "moments.sto")
    assert set(found) == set(written)
    for name, expected in written.items():
        error = np.abs(found[name] - expected)
        assert np.median(error) < (0.2 if name.startswith("pelvis") else 0.02), name
        assert np.quantile(error, 0.8) < (0.5 if name.startswith("pelvis") else 0.1), name


def test_opensim_reads_the_markers(export, folder: Path) -> None:
    read = osim.MarkerData(str(folder / "markers.trc"))
    assert (read.getNumMarkers(), read.getNumFrames()) == (12, 1141)
    assert (read.getDataRate(), read.getUnits().getLabel()) == (1000.0, "millimeters")
    samples = Samples(export.gait, 1000.0)
    for frame in (0, 500, 1140):
        hip = read.getFrame(frame).getMarker(read.getMarkerIndex("Hip"))
        expected = 1000 * samples.hip()[frame]
        assert [hip.get(0), hip.get(1), hip.get(2)] == pytest.approx([*expected, 0], abs=1e-5)


def test_opensim_reads_coordinates_in_degrees(folder: Path) -> None:
    storage = osim.Storage(str(folder / "angles.mot"))
    assert storage.isInDegrees()
    assert storage.getSize() == 1141
    assert not osim.Storage(str(folder / "moments.sto")).isInDegrees()
