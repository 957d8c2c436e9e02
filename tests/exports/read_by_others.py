#!/usr/bin/python3
"""Every export, opened by readers that know nothing of this program.

read_by_others.py PROGRAM --node-modules FOLDER [unittest's arguments]

VTK reads its own formats and plays the glTF, which the validator of the Khronos Group (in FOLDER) judges as well. JSON
is held against schemas written from the definitions of ROS messages and of QGroundControl's plans, and numbers against
trajectory.csv. The schemas that the program prints are held against all files that come along.
"""

import argparse
import csv
import functools
import glob
import json
import math
import os
import struct
import subprocess
import sys
import tempfile
import unittest

import jsonschema
import numpy as np
import vtk
import yaml
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
arguments = None  # of the command line: program, node_modules
scratch = tempfile.TemporaryDirectory()

# Boxes; boxes in a turned plane far from the world's origin; meshes and a scan; cylinders.
SHIPPED = ["bridge_inspection", "culvert", "girder_mesh", "pipe_rack"]
# What no shipped problem has, as a change of open_air.
INVENTED = {
    "nothing": [],
    "round": [{"name": "ball", "sphere": {"radius_m": 0.5, "center_m": [0, 3, 7]}},
              {"name": "ä \"pipe\" <&>", "cylinder": {"radius_m": 0.3, "length_m": 4, "axis": [1, 2, -2],
                                                      "center_m": [1, 4, 8], "rpy_deg": [10, -20, 30]}},
              {"name": "plate", "box": {"size_m": [1, 2, 0.2], "center_m": [2, -5, 3], "rpy_deg": [10, -20, 130]}}]}


def program(*words):
    return subprocess.run([arguments.program, *words], check=True, stdout=subprocess.PIPE, cwd=scratch.name).stdout


def loaded(path):
    """Of a file of YAML or JSON."""
    with open(path, encoding="utf-8") as file:
        return json.load(file) if path.endswith((".json", ".plan")) else yaml.safe_load(file)


def csv_columns(path):
    """By name; what is empty is not a number."""
    with open(path, newline="", encoding="utf-8") as file:
        names, *rows = csv.reader(file, strict=True)
    return dict(zip(names, np.array([[float(cell or "nan") for cell in row] for row in rows]).T))


def problem_file(name):
    if name in SHIPPED:
        return f"{ROOT}/problems/{name}.yaml"
    problem = loaded(f"{ROOT}/problems/open_air.yaml")
    problem["robot"] = f"{ROOT}/problems/{problem['robot']}"
    problem["environment"]["obstacles"] = INVENTED[name]
    path = f"{scratch.name}/{name}.yaml"
    with open(path, "w", encoding="utf-8") as file:
        yaml.safe_dump(problem, file)
    return path


class Run:
    """What the program left of a short search."""

    def __init__(self, name):
        self.folder = f"{scratch.name}/{name}"
        program("solve", problem_file(name), "--max-iterations", "300", "--no-cache", "--quiet", "--out", self.folder)
        self.problem = loaded(f"{self.folder}/effective.yaml")
        self.solution = loaded(f"{self.folder}/solution.json")
        self.flight = csv_columns(f"{self.folder}/trajectory.csv")
        self.obstacles = self.problem["environment"]["obstacles"] or []
        plane = self.problem["environment"]["plane"]
        self.origin_m, self.heading_rad = np.array(plane["origin_m"]), math.radians(plane["heading_deg"])

    def export(self, form, *options):
        return program("export", self.folder, "--format", form, *options).decode().strip()

    def world(self, x_m, z_m):
        """Of places in the plane of motion, a row each."""
        sine, cosine = math.sin(self.heading_rad), math.cos(self.heading_rad)
        return self.origin_m + np.stack([x_m * cosine, x_m * sine, z_m], axis=-1)


run_of = functools.cache(Run)


def for_each_run(test):
    """A test of one run as a test of all."""
    @functools.wraps(test)
    def tests(self):
        for name in [*SHIPPED, *INVENTED]:
            with self.subTest(name):
                test(self, run_of(name))

    return tests


class ReadByOthers(unittest.TestCase):
    def near(self, found, expected, tolerance):
        np.testing.assert_allclose(found, expected, rtol=0, atol=tolerance)


def validator(schema):
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


def groups_of(document):
    if isinstance(document, dict):
        yield document
    if isinstance(document, (dict, list)):
        for part in document.values() if isinstance(document, dict) else document:
            yield from groups_of(part)


def misspelt(document):
    """The document with a misspelt key beside the right one, for every key; changed in place."""
    for group in list(groups_of(document)):
        for key in list(group):
            group[key + "_"] = group[key]
            yield key, document
            del group[key + "_"]


def mavlink_checksum(message):
    """CRC-16/MCRF4XX, as mavlink.io's guide to serialization has it."""
    checksum = 0xFFFF
    for byte in message:
        mixed = byte ^ (checksum & 0xFF)
        mixed ^= (mixed << 4) & 0xFF
        checksum = (checksum >> 8) ^ (mixed << 8) ^ (mixed << 3) ^ (mixed >> 4)
    return checksum


# --- set-points -------------------------------------------------------------------------------------------------------


class SetPoints(ReadByOthers):
    @for_each_run
    def test_csv_holds_the_reference_that_was_flown(self, run):
        points, flight = csv_columns(run.export("csv")), run.flight
        self.near(points["t_s"], flight["t_s"], 1e-9)
        places = np.stack([points[name] for name in ("x_m", "y_m", "z_m")], axis=-1)
        self.near(places, run.world(flight["ref_x_m"], flight["ref_z_m"]), 1e-9)
        self.near(points["arm_rad"], flight["ref_arm_rad"], 1e-12)
        self.near(points["yaw_rad"], run.heading_rad, 1e-12)

    @for_each_run
    def test_speeds_and_accelerations_are_differences_of_what_stands_before_them(self, run):
        points = csv_columns(run.export("csv", "--rate", "1000"))
        for axis in "xyz":
            speed, acceleration = points[f"v{axis}_m_s"], points[f"a{axis}_m_s2"]
            self.near(np.gradient(points[f"{axis}_m"], points["t_s"])[1:-1], speed[1:-1], 1e-3)
            self.near(np.gradient(speed, points["t_s"])[1:-1], acceleration[1:-1], 1e-2)
        speed = points["arm_rate_rad_s"]
        self.near(np.gradient(points["arm_rad"], points["t_s"])[1:-1], speed[1:-1], 1e-3)
        self.near(np.gradient(speed, points["t_s"])[1:-1], points["arm_acceleration_rad_s2"][1:-1], 5e-2)

    @for_each_run
    def test_ros_messages_are_what_their_definitions_say_and_hold_the_set_points(self, run):
        messages_of_ros = validator(loaded(f"{HERE}/ros_trajectory.schema.json"))
        messages = loaded(run.export("ros", "--rate", "20"))
        messages_of_ros.validate(messages)
        points = csv_columns(run.export("csv", "--rate", "20"))
        vehicle, arm = messages["multi_dof_joint_trajectory"], messages["joint_trajectory"]
        for message in (vehicle, arm):
            times = [at["time_from_start"]["sec"] + 1e-9 * at["time_from_start"]["nanosec"] for at in message["points"]]
            self.near(times, points["t_s"], 1e-9)
            self.assertTrue(np.all(np.diff(times) > 0))
        self.assertEqual((len(vehicle["joint_names"]), len(arm["joint_names"])), (1, 1))

        def vectors(of, part):
            return [[[one[part][axis] for axis in "xyz"] for one in at[of]] for at in vehicle["points"]]

        def columns(*names):
            return np.stack([points[name] for name in names], axis=-1)[:, np.newaxis]

        self.near(vectors("transforms", "translation"), columns("x_m", "y_m", "z_m"), 0)
        self.near(vectors("velocities", "linear"), columns("vx_m_s", "vy_m_s", "vz_m_s"), 0)
        self.near(vectors("accelerations", "linear"), columns("ax_m_s2", "ay_m_s2", "az_m_s2"), 0)
        for at in vehicle["points"]:
            turned = vtk.vtkQuaterniond(*(at["transforms"][0]["rotation"][part] for part in "wxyz"))
            axis = [0.0, 0.0, 0.0]
            angle_rad = turned.GetRotationAngleAndAxis(axis)
            self.assertAlmostEqual(turned.Norm(), 1, places=12)
            self.near(angle_rad * np.array(axis), [0, 0, run.heading_rad], 1e-12)
        for of, name in (("positions", "arm_rad"), ("velocities", "arm_rate_rad_s"),
                         ("accelerations", "arm_acceleration_rad_s2")):
            self.near([at[of] for at in arm["points"]], points[name][:, np.newaxis], 0)

    @for_each_run
    def test_px4_messages_have_the_members_of_their_definition_and_lie_north_east_and_down(self, run):
        bearing_deg = 130
        options = ("--rate", "20", "--bearing", str(bearing_deg))
        messages = loaded(run.export("px4", *options))
        points, table = csv_columns(run.export("csv", "--rate", "20")), csv_columns(run.export("px4-csv", *options))
        for message in messages["trajectory_setpoints"]:
            self.assertEqual(set(message), {"timestamp", "position", "velocity", "acceleration", "jerk", "yaw", "yawspeed"})
        # The world turned to a map (x east, y north), then its axes in another order.
        angle = math.radians(90 - bearing_deg)
        to_map = np.array([[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]])
        from_map = np.array([[0, 1, 0], [1, 0, 0], [0, 0, -1]])
        for member, names in (("position", "{}_m"), ("velocity", "v{}_m_s"), ("acceleration", "a{}_m_s2")):
            expected = np.stack([points[names.format(axis)] for axis in "xyz"]).T @ (from_map @ to_map).T
            found = np.array([message[member] for message in messages["trajectory_setpoints"]])
            self.near(found, expected, 1e-9)
            self.near(np.stack([table[f"{member}[{axis}]"] for axis in range(3)]).T, found, 0)
        times = np.array([message["timestamp"] for message in messages["trajectory_setpoints"]])
        self.near(times / 1e6, points["t_s"], 1e-6)
        self.near(table["timestamp"], times, 0)
        yaw = np.array([message["yaw"] for message in messages["trajectory_setpoints"]])
        self.near(np.remainder(math.radians(bearing_deg) - points["yaw_rad"] - yaw + np.pi, 2 * np.pi), np.pi, 1e-9)
        self.assertTrue(np.all(np.abs(yaw) <= np.pi))
        self.near(table["arm_rad"], points["arm_rad"], 0)

    @for_each_run
    def test_mavlink_frames_have_the_checksum_and_the_fields_that_the_protocol_documents(self, run):
        with open(run.export("mavlink", "--rate", "50", "--bearing", "-40"), "rb") as file:
            log = file.read()
        messages = loaded(run.export("px4", "--rate", "50", "--bearing", "-40"))["trajectory_setpoints"]
        sequence = 0
        while log:
            (time_us,) = struct.unpack(">Q", log[:8])
            length = log[9]
            frame, checksum = log[8:18 + length], log[18 + length:20 + length]
            log = log[20 + length:]
            self.assertEqual(struct.unpack("<H", checksum)[0], mavlink_checksum(frame[1:] + bytes([143])))  # CRC_EXTRA
            self.assertEqual((frame[0], frame[4], frame[5], frame[6]), (0xFD, sequence % 256, 1, 191))
            self.assertEqual(int.from_bytes(frame[7:10], "little"), 84)
            time_ms, *numbers, mask, system, component, axes = struct.unpack("<I11fHBBB", frame[10:].ljust(53, b"\0"))
            self.assertEqual((mask, system, component, axes), (0, 1, 1, 1))
            self.assertEqual(time_us, 1000 * time_ms)
            message = messages[sequence]
            self.assertLess(abs(time_us - message["timestamp"]), 501)
            self.near(numbers, [*message["position"], *message["velocity"], *message["acceleration"], message["yaw"],
                                message["yawspeed"]], 1e-3)
            sequence += 1
        self.assertEqual(sequence, len(messages))

    def test_ros_definitions_refuse_every_misspelt_member(self):
        messages_of_ros = validator(loaded(f"{HERE}/ros_trajectory.schema.json"))
        for key, message in misspelt(loaded(run_of("culvert").export("ros", "--rate", "0.2"))):
            self.assertFalse(messages_of_ros.is_valid(message), key)


# --- missions ---------------------------------------------------------------------------------------------------------


def earth_centred(latitude_deg, longitude_deg, height_m):
    """Of a place on the ellipsoid of WGS 84."""
    radius_m, flattening = 6378137.0, 1 / 298.257223563
    squared = flattening * (2 - flattening)
    latitude, longitude = math.radians(latitude_deg), math.radians(longitude_deg)
    normal_m = radius_m / math.sqrt(1 - squared * math.sin(latitude) ** 2)
    return np.array([(normal_m + height_m) * math.cos(latitude) * math.cos(longitude),
                     (normal_m + height_m) * math.cos(latitude) * math.sin(longitude),
                     (normal_m * (1 - squared) + height_m) * math.sin(latitude)])


def seen_from(origin, bearing_deg, place):
    """A place on the Earth in a world frame that lies at another."""
    latitude, longitude, bearing = (math.radians(angle) for angle in (origin[0], origin[1], bearing_deg))
    east = np.array([-math.sin(longitude), math.cos(longitude), 0])
    north = np.array([-math.sin(latitude) * math.cos(longitude), -math.sin(latitude) * math.sin(longitude),
                      math.cos(latitude)])
    way_m = earth_centred(*place) - earth_centred(*origin)
    forward = math.sin(bearing) * east + math.cos(bearing) * north
    return np.array([way_m @ forward, way_m @ np.cross(np.cross(east, north), forward), way_m @ np.cross(east, north)])


class Missions(ReadByOthers):
    def mission(self, run, origin, bearing_deg):
        return loaded(run.export("qgc", "--origin", *map(str, origin), "--bearing", str(bearing_deg)))

    @for_each_run
    def test_missions_are_what_qgroundcontrol_documents_and_lie_where_the_plan_does(self, run):
        plans_of_qgc = validator(loaded(f"{HERE}/qgc_plan.schema.json"))
        corners = [(at["x_m"], at["z_m"]) for at in run.solution["plan"]["waypoints"]]
        for origin, bearing_deg in (((47, 8, 100), 0), ((-33.9, -70.6, 540), -300), ((0, 179.99999, 0), 90)):
            plan = self.mission(run, origin, bearing_deg)
            plans_of_qgc.validate(plan)
            items = plan["mission"]["items"]
            self.assertEqual([item["doJumpId"] for item in items], list(range(1, len(items) + 1)))
            self.assertEqual(items[1]["params"][:2], [1, run.problem["motion"]["max_speed_m_s"]])
            del items[1]
            self.assertEqual(plan["mission"]["plannedHomePosition"], list(origin))
            for item, (x_m, z_m) in zip(items, corners, strict=True):
                *_, yaw_deg, latitude_deg, longitude_deg, height_m = item["params"]
                place_m = seen_from(origin, bearing_deg, (latitude_deg, longitude_deg, origin[2] + height_m))
                self.near(place_m, run.world(x_m, z_m), 0.01)
                self.near((bearing_deg - math.degrees(run.heading_rad) - yaw_deg + 180) % 360, 180, 1e-9)
                self.assertEqual(item["Altitude"], height_m)
            end_s = run.flight["t_s"][-1] - run.solution["plan"]["reference"][-1]["t_s"]
            self.near(items[-1]["params"][0], end_s, 1e-9)

    def test_missions_end_as_they_are_asked_to(self):
        plans_of_qgc = validator(loaded(f"{HERE}/qgc_plan.schema.json"))
        run = run_of("culvert")
        hover = self.mission(run, (47, 8, 100), 30)["mission"]["items"]
        for end, command in (("land", 21), ("return", 20)):
            plan = loaded(run.export("qgc", "--origin", "47", "8", "100", "--bearing", "30", "--end", end))
            plans_of_qgc.validate(plan)
            self.assertEqual(plan["mission"]["items"][:-1], hover)
            self.assertEqual(plan["mission"]["items"][-1]["command"], command)

    def test_the_documented_format_refuses_every_misspelt_key(self):
        plans_of_qgc = validator(loaded(f"{HERE}/qgc_plan.schema.json"))
        for key, plan in misspelt(self.mission(run_of("culvert"), (47, 8, 100), 30)):
            self.assertFalse(plans_of_qgc.is_valid(plan), key)


# --- scenes -----------------------------------------------------------------------------------------------------------


def output_of(reader, path):
    complaints = []
    reader.AddObserver("ErrorEvent", lambda *_: complaints.append(path))
    reader.SetFileName(path)
    reader.Update()
    assert not complaints and reader.GetErrorCode() == 0, f"VTK does not read {path}"
    return reader.GetOutput()


def points_of(polydata):
    return vtk_to_numpy(polydata.GetPoints().GetData()).astype(float)


def volume_m3(corners_m):
    """Of what triangles enclose, by the divergence theorem; negative where they face inwards."""
    a, b, c = corners_m[:, 0], corners_m[:, 1], corners_m[:, 2]
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def triangles_of(polydata):
    return vtk_to_numpy(polydata.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def surface_of(points, triangles):
    surface, places, cells = vtk.vtkPolyData(), vtk.vtkPoints(), vtk.vtkCellArray()
    places.SetData(numpy_to_vtk(points, deep=True))
    for triangle in triangles:
        cells.InsertNextCell(3, [int(corner) for corner in triangle])
    surface.SetPoints(places)
    surface.SetPolys(cells)
    return surface


def open_edges(polydata, may_touch_itself):
    """How many edges have no second face, or more than two; points at the same place are one."""
    merged = vtk.vtkCleanPolyData()
    merged.SetInputData(polydata)
    edges = vtk.vtkFeatureEdges()
    edges.SetInputConnection(merged.GetOutputPort())
    edges.FeatureEdgesOff()
    edges.SetNonManifoldEdges(not may_touch_itself)
    edges.Update()
    return edges.GetOutput().GetNumberOfCells()


def occupied_cubes(path):
    """How many there are of each side in a file of OctoMap's: "A binary format ... two bits a child", depth first."""
    with open(path, "rb") as file:
        head, _, data = file.read().partition(b"data\n")
    resolution_m = float(head.partition(b"res ")[2].split()[0])
    bits, sides = iter(data), []

    def visit(depth):
        states = int.from_bytes(bytes([next(bits), next(bits)]), "little")
        for child in range(8):
            state = states >> (2 * child) & 3
            if state == 3:
                visit(depth + 1)
            elif state == 2:
                sides.append(resolution_m * 2 ** (15 - depth))

    visit(0)
    return np.array(sides)


class Polydata(ReadByOthers):
    @for_each_run
    def test_vtk_reads_both_ways_of_the_flight_with_every_column(self, run):
        flight = output_of(vtk.vtkXMLPolyDataReader(), run.export("vtp"))
        rows = len(run.flight["t_s"])
        self.assertEqual((flight.GetNumberOfPoints(), flight.GetNumberOfLines(), flight.GetNumberOfCells()),
                         (2 * rows, 2, 2))
        self.near(points_of(flight), np.concatenate([run.world(run.flight["x_m"], run.flight["z_m"]),
                                                     run.world(run.flight["ee_x_m"], run.flight["ee_z_m"])]), 1e-12)
        data = flight.GetPointData()
        known = [name for name, column in run.flight.items() if not np.isnan(column).any()]
        self.assertEqual([data.GetArrayName(i) for i in range(data.GetNumberOfArrays())], known)
        for name in known:
            self.near(vtk_to_numpy(data.GetArray(name)), np.tile(run.flight[name], 2), 0)
        for line, is_end_effector in enumerate(vtk_to_numpy(flight.GetCellData().GetArray("is_end_effector"))):
            points = flight.GetCell(line).GetPointIds()
            self.assertEqual(points.GetNumberOfIds(), rows)
            self.near([points.GetId(i) for i in range(rows)], rows * is_end_effector + np.arange(rows), 0)

    @for_each_run
    def test_vtk_reads_obstacles_as_closed_solids_where_the_problem_has_them(self, run):
        scene = output_of(vtk.vtkXMLPolyDataReader(), run.export("vtp-scene"))
        names = scene.GetFieldData().GetAbstractArray("obstacles")
        self.assertEqual([names.GetValue(i) for i in range(names.GetNumberOfValues())],
                         [obstacle["name"] for obstacle in run.obstacles])
        if not run.obstacles:
            self.assertEqual(scene.GetNumberOfCells(), 0)
            return
        owners = vtk_to_numpy(scene.GetCellData().GetArray("obstacle"))
        points_m, triangles = points_of(scene), triangles_of(scene)
        for index, obstacle in enumerate(run.obstacles):
            with self.subTest(obstacle["name"]):
                (kind, shape), = ((key, value) for key, value in obstacle.items() if key != "name")
                placed = vtk.vtkTransform()
                placed.Translate(shape["center_m"])
                for turn, angle_deg in zip((placed.RotateZ, placed.RotateY, placed.RotateX), shape["rpy_deg"][::-1]):
                    turn(angle_deg)
                back = placed.GetLinearInverse()
                own = triangles[owners == index]
                self.assertEqual(open_edges(surface_of(points_m, own), kind == "octomap"), 0)
                own_m = np.array([back.TransformPoint(point) for point in points_m[own].reshape(-1, 3)])
                getattr(self, "check_" + kind)(run, shape, own_m.reshape(-1, 3, 3))

    def check_box(self, run, box, corners_m):
        half_m = np.array(box["size_m"]) / 2
        self.near(abs(corners_m), np.broadcast_to(half_m, corners_m.shape), 1e-9)
        self.near(volume_m3(corners_m) / (8 * half_m.prod()), 1, 1e-9)

    def check_sphere(self, run, sphere, corners_m):
        self.near(np.linalg.norm(corners_m, axis=-1), sphere["radius_m"], 1e-9)
        self.near(volume_m3(corners_m) / (4 / 3 * math.pi * sphere["radius_m"] ** 3), 0.99, 0.01)

    def check_cylinder(self, run, cylinder, corners_m):
        along_m = corners_m @ cylinder["axis"] / np.linalg.norm(cylinder["axis"])
        off_m = np.sqrt(np.maximum(0, (corners_m**2).sum(axis=-1) - along_m**2))
        self.near(abs(along_m), cylinder["length_m"] / 2, 1e-9)
        self.near(np.minimum(off_m, abs(off_m - cylinder["radius_m"])), 0, 1e-6)  # in the middle or on the rim
        whole_m3 = math.pi * cylinder["radius_m"] ** 2 * cylinder["length_m"]
        self.near(volume_m3(corners_m) / whole_m3, 0.995, 0.005)

    def check_mesh(self, run, mesh, corners_m):
        file = output_of(vtk.vtkSTLReader(), os.path.join(run.folder, mesh["file"]))
        corners = mesh["scale"] * points_of(file)[triangles_of(file)]
        self.near(corners_m, corners, 1e-9)
        self.assertGreater(volume_m3(corners), 0)

    def check_octomap(self, run, octomap, corners_m):
        sides_m = occupied_cubes(os.path.join(run.folder, octomap["file"]))
        self.assertEqual(len(corners_m), 12 * len(sides_m))
        cubes = corners_m.reshape(len(sides_m), 36, 3)
        self.near(np.sort(np.ptp(cubes, axis=1), axis=0), np.sort(sides_m)[:, np.newaxis].repeat(3, axis=1), 1e-9)
        self.near(volume_m3(corners_m) / (sides_m**3).sum(), 1, 1e-9)


class Gltf(ReadByOthers):
    def report(self, path):
        found = subprocess.run(["node", f"{HERE}/gltf_report.js", path], check=True, stdout=subprocess.PIPE,
                               env={**os.environ, "NODE_PATH": os.path.abspath(arguments.node_modules)})
        return json.loads(found.stdout)

    @for_each_run
    def test_khronos_validator_has_nothing_against_it(self, run):
        report = self.report(run.export("glb"))
        self.assertEqual((report["issues"]["numErrors"], report["issues"]["numWarnings"]), (0, 0), report["issues"])
        self.assertEqual(report["info"]["animationCount"], 1)

    def test_khronos_validator_complains_of_a_damaged_file(self):
        path = run_of("culvert").export("glb")
        with open(path, "rb") as file:
            sound = file.read()
        for old, new in ((b'"count"', b'"cuont"'), (b'"byteOffset":0', b'"byteOffset":3'), (b"POSITION", b"PLACE_AT")):
            self.assertIn(old, sound)
            with open(path + ".damaged", "wb") as file:
                file.write(sound.replace(old, new, 1))
            self.assertGreater(self.report(path + ".damaged")["issues"]["numErrors"], 0, new)

    @for_each_run
    def test_vtk_plays_the_flight(self, run):
        # Obstacles, body, rotors, arm and way, as they were added; the format's y points up.
        before = len(run.obstacles)
        rotors = len(run.problem["robot"]["rotors"]["positions_m"])
        reader = vtk.vtkGLTFReader()
        reader.SetFileName(run.export("glb"))
        reader.SetFrameRate(100)
        reader.ApplyDeformationsToGeometryOn()
        reader.UpdateInformation()
        self.assertEqual(reader.GetNumberOfAnimations(), 1)
        self.near(reader.GetAnimationDuration(0), run.flight["t_s"][-1], 1e-5)
        reader.EnableAnimation(0)
        reader.UpdateInformation()
        for row in range(0, len(run.flight["t_s"]), 500):
            at = {name: column[row] for name, column in run.flight.items()}
            reader.UpdateTimeStep(at["t_s"])
            parts = self.leaves(reader.GetOutput())
            self.assertEqual(len(parts), before + 1 + rotors + 2)
            body, arm, way = parts[before], parts[-2], parts[-1]
            place_m, tip_m = run.world(at["x_m"], at["z_m"]), run.world(at["ee_x_m"], at["ee_z_m"])
            scale = 1e-6 * max(1, abs(place_m).max())  # single precision
            self.near(body.mean(axis=0), place_m, scale)
            self.near(arm.mean(axis=0), (place_m + tip_m) / 2, scale)
            self.near(way[row], place_m, scale)

    def leaves(self, blocks):
        found, each = [], blocks.NewIterator()
        each.InitTraversal()
        while not each.IsDoneWithTraversal():
            points = points_of(each.GetCurrentDataObject())
            found.append(np.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=-1))
            each.GoToNextItem()
        return found


# --- schemas ----------------------------------------------------------------------------------------------------------


class Schemas(ReadByOthers):
    FILES = {"problem": ["problems/*.yaml", "problems/templates/*.yaml", "docs/figures/*.yaml",
                         "bench/aero_map/*.yaml"],
             "robot": ["problems/robots/*.yaml"],
             "campaign": ["bench/campaigns/*.yaml"]}

    def for_each_file(self, check):
        for kind, patterns in self.FILES.items():
            schema = validator(json.loads(program("check", "--schema", kind)))
            files = [path for pattern in patterns for path in glob.glob(f"{ROOT}/{pattern}")]
            self.assertNotEqual(files, [])
            for path in files:
                with self.subTest(os.path.relpath(path, ROOT)):
                    check(schema, loaded(path))

    def test_the_program_s_schemas_hold_for_every_file_that_comes_along(self):
        self.for_each_file(lambda schema, document: schema.validate(document))

    @for_each_run
    def test_and_for_the_problem_that_a_run_writes(self, run):
        validator(json.loads(program("check", "--schema", "problem"))).validate(run.problem)

    def test_they_refuse_every_misspelt_key(self):
        self.for_each_file(self.refuses_misspelt)

    def refuses_misspelt(self, schema, document):
        for key, wrong in misspelt(document):
            self.assertFalse(schema.is_valid(wrong), key)


def main():
    global arguments
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("--node-modules", required=True)
    arguments, rest = parser.parse_known_args()
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
