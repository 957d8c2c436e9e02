#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/exports/export_format.hpp"
#include "downwash/exports/setpoints.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/results/space_solution_file.hpp"
#include "downwash/scene/solid_surface.hpp"

// Runs in space as files for other programs. The shipped reference under a girder turns by a quarter and moves two
// joints.

using namespace downwash;
using nlohmann::json;

namespace {

constexpr double pi = 3.14159265358979323846;

/// The shipped reference, executed.
const SpaceRunRecord& girder_run() {
    static const SpaceRunRecord run = [] {
        const SpaceProblem problem = read_space_problem(DOWNWASH_PROBLEMS "/space/around_a_girder.yaml");
        SpaceSolution solution = read_solution(DOWNWASH_PROBLEMS "/space/around_a_girder.json", problem);
        solution.execution = SpaceProblemModel(problem).execute(*solution.plan);
        return run_record(problem, solution);
    }();
    return run;
}

std::string written(const char* format, const ExportSettings& settings = {}, const SpaceRunRecord& run = girder_run()) {
    const auto is_it = [format](const ExportFormat& one) { return one.name == format; };
    return exported(run, *std::ranges::find_if(export_formats, is_it), settings);
}

ExportSettings at_rate(double rate_hz, double bearing_deg = 0) {
    ExportSettings settings;
    settings.rate_hz = rate_hz;
    settings.bearing_deg = bearing_deg;
    return settings;
}

ExportSettings somewhere(double bearing_deg = 0) {
    ExportSettings settings;
    settings.origin = {47, 8, 100};
    settings.bearing_deg = bearing_deg;
    return settings;
}

double flown(const char* name, std::size_t row) {
    return girder_run().flight.find(name)->at(row);
}

std::vector<double> numbers_of(const pugi::xml_node& array) {
    std::istringstream text(array.text().get());
    std::vector<double> numbers;
    for (double number = 0; text >> number;) {
        numbers.push_back(number);
    }
    return numbers;
}

/// A binary glTF file.
class Glb {
 public:
    explicit Glb(std::string file) : file_(std::move(file)) {
        std::uint32_t size = 0;
        std::memcpy(&size, file_.data() + 12, sizeof(size));
        document = json::parse(file_.substr(20, size));
        begin_ = 20 + size + 8;
    }

    /// What moves a node in a frame, "translation" or "rotation"; its own where nothing does.
    [[nodiscard]] std::vector<double> of_node(std::size_t node, const std::string& path, std::size_t frame) const {
        const json& animation = document["animations"][0];
        for (const json& channel : animation["channels"]) {
            if (channel["target"]["node"] == node && channel["target"]["path"] == path) {
                const json& sampler = animation["samplers"][channel["sampler"].get<std::size_t>()];
                return numbers(document["accessors"][sampler["output"].get<std::size_t>()], path == "rotation" ? 4 : 3,
                               frame);
            }
        }
        return document["nodes"][node].value(
            path, path == "rotation" ? std::vector<double>{0, 0, 0, 1} : std::vector<double>{0, 0, 0});
    }

    [[nodiscard]] std::size_t node(const std::string& name) const {
        for (std::size_t i = 0; i < document["nodes"].size(); ++i) {
            if (document["nodes"][i].value("name", "") == name) {
                return i;
            }
        }
        throw std::logic_error("there is no such node");
    }

    json document;

 private:
    [[nodiscard]] std::vector<double> numbers(const json& accessor, std::size_t components, std::size_t index) const {
        const auto offset =
            document["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteOffset"].get<std::size_t>();
        std::vector<float> values(components);
        std::memcpy(values.data(), file_.data() + begin_ + offset + 4 * components * index, 4 * components);
        return {values.begin(), values.end()};
    }

    std::string file_;
    std::size_t begin_ = 0;
};

/// A vector turned by a quaternion (x, y, z, w): v + 2 u x (u x v + w v).
Vector3 turned(const std::vector<double>& q, const Vector3& v) {
    const Vector3 u{q[0], q[1], q[2]};
    return v + 2. * cross(u, cross(u, v) + q[3] * v);
}

Vector3 as_vector(const std::vector<double>& numbers) {
    return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace

TEST_CASE("set-points in space at the controller's rate are the reference that the flight recorded") {
    std::istringstream text(written("csv"));
    std::string line;
    std::getline(text, line);
    CHECK(line ==
          "t_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,ax_m_s2,ay_m_s2,az_m_s2,yaw_rad,yaw_rate_rad_s,"
          "yaw_acceleration_rad_s2,joint_1_rad,joint_1_rate_rad_s,joint_1_acceleration_rad_s2,joint_2_rad,"
          "joint_2_rate_rad_s,joint_2_acceleration_rad_s2,joint_3_rad,joint_3_rate_rad_s,joint_3_acceleration_rad_s2");
    std::size_t row = 0;
    while (std::getline(text, line)) {
        std::ranges::replace(line, ',', ' ');
        std::istringstream numbers(line);
        std::vector<double> columns;
        for (double number = 0; numbers >> number;) {
            columns.push_back(number);
        }
        REQUIRE(columns.size() == 22);
        for (const auto& [name, column] : {std::pair{"t_s", 0},
                                           {"ref_x_m", 1},
                                           {"ref_y_m", 2},
                                           {"ref_z_m", 3},
                                           {"ref_yaw_rad", 10},
                                           {"ref_joint_1_rad", 13},
                                           {"ref_joint_2_rad", 16},
                                           {"ref_joint_3_rad", 19}}) {
            REQUIRE(columns[static_cast<std::size_t>(column)] == Approx(flown(name, row)).margin(1e-9));
        }
        ++row;
    }
    CHECK(row == girder_run().flight.rows());
}

TEST_CASE("rates and accelerations of set-points in space are derivatives") {
    constexpr double rate_hz = 500;
    const std::vector<Setpoint> points = setpoints(*girder_run().plan, 0, rate_hz);
    const auto slope = [&](std::size_t i, const auto& value) {
        return (value(points[i + 1]) - value(points[i - 1])) * rate_hz / 2;
    };
    for (std::size_t i = 1; i + 2 < points.size(); ++i) {
        REQUIRE(points[i].velocity_m_s[1] ==
                Approx(slope(i, [](const Setpoint& p) { return p.position_m[1]; })).margin(1e-4));
        REQUIRE(points[i].acceleration_m_s2[2] ==
                Approx(slope(i, [](const Setpoint& p) { return p.velocity_m_s[2]; })).margin(1e-2));
        REQUIRE(points[i].yaw_rate_rad_s == Approx(slope(i, [](const Setpoint& p) { return p.yaw_rad; })).margin(1e-4));
        REQUIRE(points[i].joints[0].rate_rad_s ==
                Approx(slope(i, [](const Setpoint& p) { return p.joints[0].angle_rad; })).margin(1e-4));
    }
}

TEST_CASE("ROS messages of a run in space have its yaw and all joints by name") {
    const json messages = json::parse(written("ros", at_rate(10)));
    const json& vehicle = messages["multi_dof_joint_trajectory"]["points"];
    const json& arm = messages["joint_trajectory"];
    CHECK(arm["joint_names"] == json({"joint_1", "joint_2", "joint_3"}));
    const std::vector<Setpoint> expected = setpoints(*girder_run().plan, girder_run().flight.find("t_s")->back(), 10);
    REQUIRE(vehicle.size() == expected.size());
    REQUIRE(arm["points"].size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const json& transform = vehicle[i]["transforms"][0];
        CHECK(transform["translation"]["y"] == expected[i].position_m[1]);
        const json& q = transform["rotation"];
        CHECK(2 * std::atan2(q["z"].get<double>(), q["w"].get<double>()) == Approx(expected[i].yaw_rad).margin(1e-12));
        CHECK(vehicle[i]["velocities"][0]["angular"] ==
              json({{"x", 0.}, {"y", 0.}, {"z", expected[i].yaw_rate_rad_s}}));
        CHECK(arm["points"][i]["positions"][1] == expected[i].joints[1].angle_rad);
        CHECK(arm["points"][i]["velocities"][0] == expected[i].joints[0].rate_rad_s);
        CHECK(arm["points"][i]["time_from_start"] == vehicle[i]["time_from_start"]);
    }
    CHECK(expected.back().yaw_rad == Approx(-pi / 2));
}

TEST_CASE("PX4's set-points count north, east and down, and yaw from north within half a turn") {
    const json north = json::parse(written("px4", at_rate(10)))["trajectory_setpoints"];
    const std::vector<Setpoint> expected = setpoints(*girder_run().plan, girder_run().flight.find("t_s")->back(), 10);
    REQUIRE(north.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        // x points north: y, to the left, is west.
        const Vector3& p = expected[i].position_m;
        CHECK(north[i]["position"] == json({p[0], 0. - p[1], 0. - p[2]}));
        CHECK(north[i]["velocity"][2].get<double>() == Approx(-expected[i].velocity_m_s[2]).margin(1e-15));
        CHECK(north[i]["yaw"].get<double>() == Approx(-expected[i].yaw_rad).margin(1e-12));
        CHECK(north[i]["yawspeed"].get<double>() == Approx(-expected[i].yaw_rate_rad_s).margin(1e-15));
        CHECK(north[i]["timestamp"] == std::llround(1e6 * expected[i].t_s));
    }
    // x points east: y is north.
    const json east = json::parse(written("px4", at_rate(10, 90)))["trajectory_setpoints"];
    CHECK(east[40]["position"][0].get<double>() == Approx(expected[40].position_m[1]).margin(1e-12));
    CHECK(east[40]["position"][1].get<double>() == Approx(expected[40].position_m[0]).margin(1e-12));
    CHECK(east[40]["acceleration"][0].get<double>() == Approx(expected[40].acceleration_m_s2[1]).margin(1e-12));

    // A plan that turns on and on stays in PX4's range, and looks where it did.
    SpaceRunRecord turning = girder_run();
    for (SpaceKnot& knot : turning.plan->reference) {
        knot.point.position[space::yaw] *= 7;
    }
    const std::vector<Setpoint> turns = setpoints(*turning.plan, turning.flight.find("t_s")->back(), 10);
    const json wrapped = json::parse(written("px4", at_rate(10, 30), turning))["trajectory_setpoints"];
    CHECK(turns.back().yaw_rad < -3 * pi);
    for (std::size_t i = 0; i < turns.size(); ++i) {
        const double yaw_rad = wrapped[i]["yaw"];
        REQUIRE(std::abs(yaw_rad) <= pi);
        REQUIRE(std::cos(yaw_rad) == Approx(std::cos(pi / 6 - turns[i].yaw_rad)).margin(1e-9));
        REQUIRE(std::sin(yaw_rad) == Approx(std::sin(pi / 6 - turns[i].yaw_rad)).margin(1e-9));
    }
    CHECK_THROWS_AS(written("px4", at_rate(10, 400)), InputError);
}

TEST_CASE("a mission in space turns to the yaw of each corner") {
    const json mission = json::parse(written("qgc", somewhere()))["mission"];
    CHECK(mission["vehicleType"] == 13);  // MAV_TYPE_HEXAROTOR
    const SpacePlan& plan = *girder_run().plan;
    std::vector<json> placed;
    for (const json& item : mission["items"]) {
        if (item["frame"] == 3) {
            placed.push_back(item);
        }
    }
    REQUIRE(placed.size() == plan.reference.size());  // from rest to rest the legs are straight
    // A degree of latitude and of longitude at 47 degrees north on WGS 84 [m], from its series.
    constexpr double latitude_m = 111169.3, longitude_m = 76055.9;
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const double* at = plan.reference[i].point.position;
        const json& params = placed[i]["params"];
        CHECK((params[4].get<double>() - 47) * latitude_m == Approx(at[space::x]).margin(1e-3));
        CHECK((params[5].get<double>() - 8) * longitude_m == Approx(-at[space::y]).margin(1e-3));
        CHECK(params[6].get<double>() == Approx(at[space::z]).margin(1e-5));
        CHECK(params[3].get<double>() == Approx(-at[space::yaw] * 180 / pi).margin(1e-9));  // clockwise from north
    }
    const json turned = json::parse(written("qgc", somewhere(300)))["mission"]["items"];
    CHECK(turned.back()["params"][3].get<double>() == Approx(30));  // 300 and 90 degrees, within a turn

    // A turn on the spot is a corner of its own.
    SpaceRunRecord run = girder_run();
    SpaceKnot& last = run.plan->reference.back();
    std::copy_n(run.plan->reference[3].point.position, 3, last.point.position);
    last.point.position[space::yaw] = 1;
    const json on_the_spot = json::parse(written("qgc", somewhere(), run))["mission"]["items"];
    CHECK(on_the_spot.size() == mission["items"].size());
    CHECK(on_the_spot.back()["params"][3].get<double>() == Approx(360 - 180 / pi));
}

TEST_CASE("VTK's flight in space has the places of vehicle and end effector, and attitude and joints as columns") {
    pugi::xml_document document;
    REQUIRE(document.load_string(written("vtp").c_str()));
    const pugi::xml_node piece = document.child("VTKFile").child("PolyData").child("Piece");
    const std::size_t rows = girder_run().flight.rows();
    const std::vector<double> points = numbers_of(piece.child("Points").child("DataArray"));
    REQUIRE(points.size() == 6 * rows);
    for (const std::size_t row : {std::size_t{0}, rows / 2, rows - 1}) {
        const char* const names[] = {"x_m", "y_m", "z_m", "ee_x_m", "ee_y_m", "ee_z_m"};
        for (std::size_t k = 0; k < 6; ++k) {
            CHECK(points[3 * (k < 3 ? row : rows + row) + k % 3] == flown(names[k], row));
        }
    }
    std::vector<std::string> names;
    for (const pugi::xml_node& array : piece.child("PointData").children()) {
        names.emplace_back(array.attribute("Name").value());
    }
    CHECK(names == girder_run().flight.names);
    REQUIRE(document.load_string(written("vtp-scene").c_str()));
    CHECK(document.child("VTKFile").child("PolyData").child("Piece").attribute("NumberOfPolys").as_int() == 4 * 12);
}

TEST_CASE("the chain of a glTF robot puts its end effector where the flight has it") {
    const Glb glb(written("glb"));
    const Vector3 tool_m = girder_run().problem.robot.plant.end_effector_m;
    for (const std::size_t frame : {std::size_t{0}, std::size_t{1200}, girder_run().flight.rows() - 1}) {
        Vector3 place_m = tool_m;
        for (const char* name : {"link_3", "link_2", "link_1", "hexa370_arm3"}) {
            const std::size_t node = glb.node(name);
            place_m = as_vector(glb.of_node(node, "translation", frame)) +
                      turned(glb.of_node(node, "rotation", frame), place_m);
        }
        CHECK(place_m[0] == Approx(flown("ee_x_m", frame)).margin(1e-5));
        CHECK(place_m[1] == Approx(flown("ee_y_m", frame)).margin(1e-5));
        CHECK(place_m[2] == Approx(flown("ee_z_m", frame)).margin(1e-5));
    }
    CHECK(glb.document["animations"][0]["channels"].size() == 5);
    CHECK(glb.document["nodes"][glb.node("link_1")]["children"] == json({glb.node("link_2")}));
}

TEST_CASE("a capsule's surface is a closed one whose corners lie on the capsule") {
    const Capsule capsule{0.1, {0.2, -0.3, 0.1}, {0.5, 0.1, -0.6}};
    const Vector3 center_m{1, 2, 3};
    const TriangleMesh surface = surface_of(SpaceBodyShape{capsule, center_m});
    const Vector3 way_m = capsule.to_m - capsule.from_m;
    double length = 0, volume_m3 = 0;
    length = std::sqrt(dot(way_m, way_m));
    for (const Vector3& vertex_m : surface.vertices_m) {
        const Vector3 own_m = vertex_m - center_m - capsule.from_m;
        const double share = std::clamp(dot(own_m, way_m) / dot(way_m, way_m), 0., 1.);
        const Vector3 off_m = own_m - share * way_m;
        REQUIRE(std::sqrt(dot(off_m, off_m)) == Approx(0.1));
    }
    for (const auto& [a, b, c] : surface.triangles) {  // divergence theorem
        volume_m3 += dot(surface.vertices_m[a], cross(surface.vertices_m[b], surface.vertices_m[c])) / 6;
    }
    const double exact_m3 = pi * 0.01 * length + 4. / 3 * pi * 0.001;
    CHECK(volume_m3 < exact_m3);
    CHECK(volume_m3 > 0.98 * exact_m3);
}

TEST_CASE("a run in space with a touch has no set-points, one without a plan nothing to fly") {
    SpaceRunRecord touching = girder_run();
    SpaceContactGoal touch;
    touch.obstacle = "web";
    touching.problem.goals.insert(touching.problem.goals.begin(), SpaceGoal{touch});
    for (const char* format : {"csv", "ros", "px4"}) {
        CHECK_THROWS_WITH(written(format, {}, touching), Catch::Contains("follows the measured force"));
    }
    CHECK_FALSE(written("vtp", {}, touching).empty());
    SpaceRunRecord none = girder_run();
    none.plan.reset();
    for (auto& column : none.flight.columns) {
        column.clear();
    }
    for (const char* format : {"csv", "ros", "px4", "vtp"}) {
        CHECK_THROWS_AS(written(format, {}, none), InputError);
    }
    CHECK_THROWS_AS(written("qgc", somewhere(), none), InputError);
    CHECK(written("glb", {}, none).substr(0, 4) == "glTF");
}

TEST_CASE("a mission warns of joints that move in space, and equal runs are exported to equal bytes") {
    const auto mission = std::ranges::find_if(export_formats, [](const ExportFormat& f) { return f.name == "qgc"; });
    const std::vector<std::string> warnings = export_warnings(girder_run(), *mission);
    REQUIRE(warnings.size() == 3);
    CHECK_THAT(warnings[0], Catch::StartsWith("the plan passes obstacles at "));
    CHECK_THAT(warnings[1], Catch::StartsWith("the plan moves the arm by 7"));  // 70 degrees and what it swings
    CHECK_THAT(warnings[2], Catch::StartsWith("the plan has no certificate"));
    for (const ExportFormat& format : export_formats) {
        CAPTURE(format.name);
        CHECK(exported(girder_run(), format, somewhere()) == exported(girder_run(), format, somewhere()));
    }
}
