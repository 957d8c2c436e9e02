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

#include "../support/solved_run.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/exports/export_format.hpp"
#include "downwash/exports/setpoints.hpp"
#include "downwash/scene/solid_surface.hpp"

using namespace downwash;
using nlohmann::json;
using test::record;

namespace {

std::string written(const char* format, const RunRecord& run = record(), const ExportSettings& settings = {}) {
    for (const ExportFormat& one : export_formats) {
        if (one.name == format) {
            return exported(run, one, settings);
        }
    }
    throw std::logic_error("there is no such format");
}

std::vector<double> numbers_of(const pugi::xml_node& array) {
    std::istringstream text(array.text().get());
    std::vector<double> numbers;
    for (double number = 0; text >> number;) {
        numbers.push_back(number);
    }
    return numbers;
}

std::uint32_t word_at(const std::string& bytes, std::size_t place) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + place, sizeof(word));
    return word;
}

ExportSettings at(double latitude_deg, double longitude_deg, double bearing_deg) {
    ExportSettings settings;
    settings.origin = {latitude_deg, longitude_deg, 100};
    settings.bearing_deg = bearing_deg;
    return settings;
}

/// The run with a plan that rests at every knot, so that its legs are straight.
RunRecord resting_record() {
    RunRecord run = record();
    for (ReferenceKnot& knot : run.plan->reference) {
        knot.point = at_rest(configuration_of(knot.point));
    }
    return run;
}

/// To the north from 47 degrees north.
json mission_of(const RunRecord& run, MissionEnd end = MissionEnd::hover) {
    ExportSettings settings = at(47, 8, 0);
    settings.mission_end = end;
    return json::parse(written("qgc", run, settings))["mission"];
}

/// The items of a mission that have a place: all but commands such as that of the speed.
json placed_items(const json& mission) {
    json placed = json::array();
    for (const json& item : mission["items"]) {
        if (item["frame"] == 3) {
            placed.push_back(item);
        }
    }
    return placed;
}

pugi::xml_node piece_of(pugi::xml_document& document, const char* format) {
    REQUIRE(document.load_string(written(format).c_str()));
    return document.child("VTKFile").child("PolyData").child("Piece");
}

}  // namespace

TEST_CASE("ROS messages hold the set-points of vehicle and arm at the same times") {
    ExportSettings settings;
    settings.rate_hz = 20;
    const json messages = json::parse(written("ros", record(), settings));
    const json& vehicle = messages["multi_dof_joint_trajectory"]["points"];
    const json& arm = messages["joint_trajectory"]["points"];
    const auto expected = setpoints(*record().plan, record().problem.plane, record().flight.find("t_s")->back(), 20);
    REQUIRE(vehicle.size() == expected.size());
    REQUIRE(arm.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const json& time = vehicle[i]["time_from_start"];
        CHECK(arm[i]["time_from_start"] == time);
        CHECK(time["sec"].get<double>() + 1e-9 * time["nanosec"].get<double>() == Approx(expected[i].t_s));
        const char* const axes[] = {"x", "y", "z"};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            CHECK(vehicle[i]["transforms"][0]["translation"][axes[axis]] == expected[i].position_m[axis]);
            CHECK(vehicle[i]["velocities"][0]["linear"][axes[axis]] == expected[i].velocity_m_s[axis]);
            CHECK(vehicle[i]["accelerations"][0]["linear"][axes[axis]] == expected[i].acceleration_m_s2[axis]);
            CHECK(vehicle[i]["velocities"][0]["angular"][axes[axis]] == 0);
            CHECK(vehicle[i]["accelerations"][0]["angular"][axes[axis]] == 0);
        }
        CHECK(vehicle[i]["transforms"][0]["rotation"] == json({{"x", 0.}, {"y", 0.}, {"z", 0.}, {"w", 1.}}));
        CHECK(arm[i]["positions"][0] == expected[i].joints[0].angle_rad);
        CHECK(arm[i]["velocities"][0] == expected[i].joints[0].rate_rad_s);
        CHECK(arm[i]["accelerations"][0] == expected[i].joints[0].acceleration_rad_s2);
    }
    CHECK(messages["multi_dof_joint_trajectory"]["joint_names"].size() == vehicle[0]["transforms"].size());
}

TEST_CASE("a mission lies where the scene does") {
    const RunRecord run = resting_record();
    // A degree of latitude and of longitude at 47 degrees north on WGS 84 [m], from its series.
    constexpr double latitude_m = 111169.3, longitude_m = 76055.9;
    const double bearing_deg = GENERATE(0., 90., 210.);
    const json plan = json::parse(written("qgc", run, at(47, 8, bearing_deg)));
    CHECK(plan["fileType"] == "Plan");
    const json items = placed_items(plan["mission"]);
    REQUIRE(items.size() == run.plan->reference.size());
    CHECK(items[0]["command"] == 22);
    constexpr double earth_radius_m = 6.37e6;
    for (std::size_t i = 0; i < items.size(); ++i) {
        const Configuration corner = configuration_of(run.plan->reference[i].point);
        const json& params = items[i]["params"];
        const double angle_rad = bearing_deg / 57.295779513082320877;
        CHECK((params[4].get<double>() - 47) * latitude_m ==
              Approx(corner[plane::x] * std::cos(angle_rad)).margin(0.01));
        CHECK((params[5].get<double>() - 8) * longitude_m ==
              Approx(corner[plane::x] * std::sin(angle_rad)).margin(0.01));
        const double sagitta_m = corner[plane::x] * corner[plane::x] / (2 * earth_radius_m);
        CHECK(params[6].get<double>() == Approx(corner[plane::z] + sagitta_m).margin(1e-7));
        CHECK(items[i]["Altitude"] == params[6]);
        CHECK(params[3].get<double>() == Approx(bearing_deg).margin(1e-9));
    }
    CHECK(items.back()["params"][0].get<double>() == Approx(run.flight.find("t_s")->back() - run.plan->duration_s()));
    CHECK(plan["mission"]["plannedHomePosition"] == json({47., 8., 100.}));
    // Without a sound origin there is none.
    CHECK_THROWS_AS(written("qgc"), InputError);
    CHECK_THROWS_AS(written("qgc", record(), at(91, 0, 0)), InputError);
    CHECK_THROWS_AS(written("qgc", record(), at(std::nan(""), 0, 0)), InputError);
}

TEST_CASE("a mission climbs straight up where the plan does, and holds where the plan does, at its start too") {
    RunRecord run = resting_record();
    ReferenceKnot held = run.plan->reference[1];
    held.tick += 700;
    for (std::size_t i = 2; i < run.plan->reference.size(); ++i) {
        run.plan->reference[i].tick += 700;
    }
    run.plan->reference.insert(run.plan->reference.begin() + 2, held);
    const json held_on_its_way = placed_items(mission_of(run));
    REQUIRE(held_on_its_way.size() == run.plan->reference.size() - 1);
    CHECK(held_on_its_way[1]["params"][0].get<double>() == Approx(700 * run.plan->tick_s));

    run.plan->tick_s = 0.01;
    run.plan->reference = {{0, at_rest({-4, 2, 0})},
                           {300, at_rest({-4, 2, 0})},
                           {800, at_rest({-4, 3.5, 0})},
                           {1800, at_rest({1, 3.5, 0})}};
    const json items = placed_items(mission_of(run));
    REQUIRE(items.size() == 4);  // take-off, the stop of 3 s above it, the climb, the leg
    const int commands[] = {22, 16, 16, 16};
    const double heights_m[] = {2, 2, 3.5, 3.5};
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(items[i]["command"] == commands[i]);
        CHECK(items[i]["params"][6].get<double>() == Approx(heights_m[i]).margin(2e-6));
    }
    CHECK(items[0]["params"][0] == 0);
    CHECK(items[1]["params"][0].get<double>() == Approx(3));
    CHECK(items[2]["params"][0] == 0);
    const auto north_m = [&](std::size_t i) { return (items[i]["params"][4].get<double>() - 47) * 111169.3; };
    CHECK(north_m(2) == Approx(north_m(0)).margin(0.001));
    CHECK(north_m(3) == Approx(north_m(0) + 5).margin(0.01));
}

TEST_CASE("a mission tells the autopilot the speed of the plan after take-off") {
    RunRecord run = resting_record();
    run.problem.motion.max_speed_m_s = 1.25;
    const json items = mission_of(run)["items"];
    CHECK(items[1]["command"] == 178);  // MAV_CMD_DO_CHANGE_SPEED
    // SPEED_TYPE_GROUNDSPEED, the speed, no change of throttle.
    CHECK(items[1]["params"] == json({1., 1.25, -1., 0., 0., 0., 0.}));
    CHECK(items[1]["frame"] == 2);  // MAV_FRAME_MISSION
    for (std::size_t i = 0; i < items.size(); ++i) {
        CHECK(items[i]["doJumpId"] == i + 1);
    }
}

TEST_CASE("a mission ends in a hover unless it is to land or to return") {
    const RunRecord run = resting_record();
    const json hovering = mission_of(run)["items"];
    CHECK(hovering.back()["command"] == 16);
    json landing = mission_of(run, MissionEnd::land)["items"];
    CHECK(landing.back()["command"] == 21);
    CHECK(landing.back()["params"][4] == hovering.back()["params"][4]);
    CHECK(landing.back()["params"][5] == hovering.back()["params"][5]);
    CHECK(landing.back()["params"][6] == 0);
    landing.erase(landing.size() - 1);
    CHECK(landing == hovering);
    const json returning = mission_of(run, MissionEnd::return_home)["items"];
    CHECK(returning.size() == hovering.size() + 1);
    CHECK(returning.back()["command"] == 20);
}

TEST_CASE("a mission is for a vehicle of as many rotors") {
    RunRecord run = resting_record();
    // MAV_TYPE_QUADROTOR, _HEXAROTOR, _OCTOROTOR, _TRICOPTER, _DODECAROTOR, _GENERIC_MULTIROTOR
    for (const auto& [rotors, type] : {std::pair{4, 2}, {6, 13}, {8, 14}, {3, 15}, {12, 29}, {16, 43}}) {
        run.problem.robot.rotors.positions_m.resize(static_cast<std::size_t>(rotors));
        CHECK(mission_of(run)["vehicleType"] == type);
    }
}

TEST_CASE("a mission keeps to the curves of a plan that passes its knots at speed") {
    RunRecord run = record();
    run.plan->tick_s = 0.01;
    ReferencePoint passing = at_rest({1, 3, 0});
    passing.velocity[0] = 1;
    passing.velocity[1] = 1;
    run.plan->reference = {{0, at_rest({-4, 3, 0})}, {500, passing}, {1000, at_rest({1, 8, 0})}};
    const json items = placed_items(mission_of(run));
    REQUIRE(items.size() > 6);
    CHECK(items.size() < 100);
    std::vector<std::array<double, 2>> corners;
    for (const json& item : items) {
        corners.push_back({(item["params"][4].get<double>() - 47) * 111169.3, item["params"][6].get<double>()});
    }
    double from_knot_m = 1;
    for (const Setpoint& point : setpoints(*run.plan, {}, 0, 50)) {
        double nearest_m = 1e9;
        for (std::size_t i = 1; i < corners.size(); ++i) {
            const auto [x0, z0] = corners[i - 1];
            const auto [x1, z1] = corners[i];
            const double length_2 = (x1 - x0) * (x1 - x0) + (z1 - z0) * (z1 - z0);
            const double dx = point.position_m[0] - x0, dz = point.position_m[2] - z0;
            const double share = length_2 > 0 ? std::clamp((dx * (x1 - x0) + dz * (z1 - z0)) / length_2, 0., 1.) : 0;
            nearest_m = std::min(nearest_m, std::hypot(dx - share * (x1 - x0), dz - share * (z1 - z0)));
        }
        CHECK(nearest_m < 0.021);
    }
    for (const auto& [x_m, z_m] : corners) {
        from_knot_m = std::min(from_knot_m, std::hypot(x_m - 1, z_m - 3));
    }
    CHECK(from_knot_m < 0.001);
}

TEST_CASE("a run that touches something has no set-points and no mission") {
    RunRecord run = record();
    run.problem.goal.kind = ContactGoal{};
    for (const char* format : {"csv", "ros"}) {
        CHECK_THROWS_WITH(written(format, run), Catch::Contains("follows the measured force"));
    }
    CHECK_THROWS_WITH(written("qgc", run, at(47, 8, 0)), Catch::Contains("follows the measured force"));
    CHECK_FALSE(written("vtp", run).empty());
}

TEST_CASE("VTK's flight holds every column at every point of both ways") {
    pugi::xml_document document;
    const pugi::xml_node piece = piece_of(document, "vtp");
    const std::size_t rows = record().flight.rows();
    CHECK(piece.attribute("NumberOfPoints").as_ullong() == 2 * rows);
    const auto points = numbers_of(piece.child("Points").child("DataArray"));
    REQUIRE(points.size() == 6 * rows);
    CHECK(points[3 * (rows - 1)] == record().flight.find("x_m")->back());
    CHECK(points.back() == record().flight.find("ee_z_m")->back());
    std::size_t arrays = 0;
    for (const pugi::xml_node& array : piece.child("PointData").children()) {
        const auto numbers = numbers_of(array);
        REQUIRE(numbers.size() == 2 * rows);
        CHECK(numbers[7] == record().flight.find(array.attribute("Name").value())->at(7));
        ++arrays;
    }
    CHECK(arrays == record().flight.columns.size());
}

TEST_CASE("VTK's scene says of every triangle whose it is") {
    pugi::xml_document document;
    const pugi::xml_node piece = piece_of(document, "vtp-scene");
    const auto triangles = piece.attribute("NumberOfPolys").as_ullong();
    CHECK(triangles == 12 * record().problem.obstacles.size());  // boxes
    CHECK(numbers_of(piece.child("CellData").child("DataArray")).size() == triangles);
    CHECK(numbers_of(piece.child("Polys").child("DataArray")).size() == 3 * triangles);
}

TEST_CASE("glTF moves vehicle and arm along the flight") {
    const std::string file = written("glb");
    REQUIRE(file.substr(0, 4) == "glTF");
    CHECK(word_at(file, 4) == 2);
    CHECK(word_at(file, 8) == file.size());
    const std::size_t json_size = word_at(file, 12);
    CHECK(json_size % 4 == 0);
    const json document = json::parse(file.substr(20, json_size));
    const std::size_t begin = 20 + json_size + 8;
    CHECK(word_at(file, begin - 8) == document["buffers"][0]["byteLength"]);
    const auto number = [&](const json& accessor, std::size_t index) {
        float value = 0;
        const auto offset = document["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteOffset"];
        std::memcpy(&value, file.data() + begin + offset.get<std::size_t>() + 4 * index, 4);
        return static_cast<double>(value);
    };
    const json& animation = document["animations"][0];
    REQUIRE(animation["channels"].size() == 3);
    const std::size_t last = record().flight.rows() - 1;
    for (const json& channel : animation["channels"]) {
        const json& sampler = animation["samplers"][channel["sampler"].get<std::size_t>()];
        const json& output = document["accessors"][sampler["output"].get<std::size_t>()];
        CHECK(document["accessors"][sampler["input"].get<std::size_t>()]["count"] == last + 1);
        const std::string node = document["nodes"][channel["target"]["node"].get<std::size_t>()]["name"];
        if (channel["target"]["path"] == "translation") {
            CHECK(number(output, 3 * last) == Approx(record().flight.find("x_m")->back()));
            CHECK(number(output, 3 * last + 2) == Approx(record().flight.find("z_m")->back()));
        } else {
            // About y, which points to the left: positive is nose down.
            const char* angle = node == "arm" ? "arm_rad" : "pitch_rad";
            CHECK(number(output, 4 * last + 1) ==
                  Approx(std::sin(record().flight.find(angle)->back() / 2)).margin(1e-6));
        }
    }
}

TEST_CASE("glTF far from the world's origin is as exact as near to it") {
    RunRecord far = record();
    const PlaneOfMotion plane({91234.5, 83456.7, 512.3}, 0.5);
    far.problem.plane = plane;
    far.problem.obstacles = {{"near", Box{{8, 6, 0.6}}, {91237.1, 83458.2, 518.6}, {0, 0, 0.5}},
                             {"origin", Sphere{1}, {0.25, 0.5, 0.75}, {}}};
    const std::string file = written("glb", far);
    const std::size_t json_size = word_at(file, 12);
    const json document = json::parse(file.substr(20, json_size));
    const json& nodes = document["nodes"];
    const auto numbers_at = [&](const json& accessor) {
        const auto offset = document["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteOffset"];
        std::vector<float> values(3 * accessor["count"].get<std::size_t>());
        std::memcpy(values.data(), file.data() + 20 + json_size + 8 + offset.get<std::size_t>(), 4 * values.size());
        return values;
    };
    const auto moved_by = [](const json& node) { return node.value("translation", std::vector<double>{0, 0, 0}); };
    const json& top = nodes[document["scenes"][0]["nodes"][0].get<std::size_t>()];
    REQUIRE(top["children"].size() == 1);
    const json& origin = nodes[top["children"][0].get<std::size_t>()];
    CHECK(origin["name"] == "origin");
    CHECK(moved_by(origin) == std::vector<double>{91000, 83000, 1000});
    std::size_t compared = 0;
    for (const json& child : origin["children"]) {
        const json& node = nodes[child.get<std::size_t>()];
        for (std::size_t i = 0; i < far.problem.obstacles.size(); ++i) {
            if (node["name"] != far.problem.obstacles[i].name) {
                continue;
            }
            const TriangleMesh expected = surface_of(far.problem.obstacles[i]);
            const json& primitive = document["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0];
            const auto found =
                numbers_at(document["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()]);
            REQUIRE(found.size() == 3 * expected.vertices_m.size());
            for (std::size_t k = 0; k < found.size(); ++k) {
                const double place = moved_by(origin)[k % 3] + moved_by(node)[k % 3] + static_cast<double>(found[k]);
                REQUIRE(place == Approx(expected.vertices_m[k / 3][k % 3]).epsilon(0).margin(1e-4));
            }
            ++compared;
        }
    }
    CHECK(compared == 2);
    const json& animation = document["animations"][0];
    for (const json& channel : animation["channels"]) {
        if (channel["target"]["path"] == "translation") {
            const json& sampler = animation["samplers"][channel["sampler"].get<std::size_t>()];
            const auto found = numbers_at(document["accessors"][sampler["output"].get<std::size_t>()]);
            REQUIRE(found.size() == 3 * far.flight.rows());
            for (std::size_t row = 0; row < far.flight.rows(); ++row) {
                const Vector3 expected =
                    plane.to_world((*far.flight.find("x_m"))[row], 0, (*far.flight.find("z_m"))[row]);
                for (std::size_t k = 0; k < 3; ++k) {
                    REQUIRE(moved_by(origin)[k] + static_cast<double>(found[3 * row + k]) ==
                            Approx(expected[k]).epsilon(0).margin(1e-4));
                }
            }
        }
    }
    const json& vehicle = nodes[animation["channels"][0]["target"]["node"].get<std::size_t>()];
    const Vector3 start = plane.to_world(far.flight.find("x_m")->front(), 0, far.flight.find("z_m")->front());
    for (std::size_t k = 0; k < 3; ++k) {
        CHECK(moved_by(origin)[k] + moved_by(vehicle)[k] == Approx(start[k]).epsilon(0).margin(1e-9));
    }
}

TEST_CASE("a run without a plan has nothing to fly, but a scene, and equal runs are exported to equal bytes") {
    RunRecord none = record();
    none.plan.reset();
    for (auto& column : none.flight.columns) {
        column.clear();
    }
    for (const char* format : {"csv", "ros", "vtp"}) {
        CHECK_THROWS_AS(written(format, none), InputError);
    }
    CHECK_THROWS_AS(written("qgc", none, at(47, 8, 0)), InputError);
    CHECK_FALSE(written("vtp-scene", none).empty());
    CHECK(written("glb", none).substr(0, 4) == "glTF");
    for (const ExportFormat& format : export_formats) {
        CAPTURE(format.name);
        CHECK(exported(record(), format, at(47, 8, 0)) == exported(record(), format, at(47, 8, 0)));
    }
}

TEST_CASE("a mission warns of what it leaves out and cannot keep, other formats of nothing") {
    const auto warnings_of = [](const RunRecord& run, std::string_view name) {
        const auto format =
            std::ranges::find_if(export_formats, [name](const ExportFormat& each) { return each.name == name; });
        return export_warnings(run, *format);
    };
    RunRecord run = record();
    run.flight = {{"arm_rad", "clearance_m"}, {{0.1, 0.3, 0.2}, {0.5, 0.1, 0.4}}, {2, 3, 4}};
    run.solution_text = R"({"certificate": {"given": false}})";
    const std::vector<std::string> all = warnings_of(run, "qgc");
    REQUIRE(all.size() == 3);
    CHECK_THAT(all[0],
               Catch::StartsWith("the plan passes obstacles at 0.1 m, but an autopilot may cut corners by 0.2 m"));
    CHECK_THAT(all[1], Catch::StartsWith("the plan moves the arm by 11 degrees"));
    CHECK_THAT(all[2], Catch::StartsWith("the plan has no certificate"));
    CHECK(warnings_of(run, "csv").empty());
    run.flight.columns = {{0.1, 0.1, 0.1}, {0.5, std::nan(""), 0.4}};
    run.solution_text = R"({"certificate": {"given": true}})";
    CHECK(warnings_of(run, "qgc").empty());
}
