#include <catch2/catch.hpp>
#include <sstream>
#include <string>

#include "program.hpp"

// What `identify` learns from a trajectory.csv of ours, and what it refuses.

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;
using Json = nlohmann::json;

namespace {

const std::string robot = DOWNWASH_PROBLEMS "/robots/ars_lrm_space.yaml";

/// A flight of three seconds in free air, in a world or in the nominal one.
void fly(const Workspace& work, const std::string& out, const char* world) {
    Json knots = Json::array();
    const double places[][4] = {{0, 0, 2, 0}, {0.2, -0.15, 2.2, 0.2}, {-0.1, 0.15, 1.9, -0.1}, {0.1, 0, 2.1, 0.1}};
    for (int i = 0; i < 4; ++i) {
        Json knot{
            {"t_s", i}, {"x_m", places[i][0]}, {"y_m", places[i][1]}, {"z_m", places[i][2]}, {"yaw_rad", places[i][3]}};
        knot["joint_1_rad"] = i % 2 == 0 ? 0.2 : -0.1;
        knots.push_back(knot);
    }
    write_file(work.in_run("plan.json"),
               Json{{"schema", "downwash/solution/v1"}, {"plan", {{"reference", knots}}}}.dump());
    write_file(work.in_run("air.yaml"),
               "schema: downwash/problem/v1\nname: air\nrobot: " + robot +
                   "\nenvironment: {bounds: {x_m: [-3, 3], y_m: [-3, 3], z_m: [0.5, 5]}, obstacles: []}\n"
                   "uncertainty: {}\nstart: {x_m: 0, y_m: 0, z_m: 2, yaw_deg: 0, joints_deg: [11.459155902616466]}\n"
                   "goal: {configuration: {x_m: 0.1, y_m: 0, z_m: 2.1, tolerance_m: 0.5}, hold_s: 1}\n");
    static_cast<void>(work.run("execute air.yaml --plan plan.json --quiet", world, "--out", out));
}

}  // namespace

TEST_CASE("A flight tells the robot that flew it, and the file that comes of it can be planned with") {
    const Workspace work;
    fly(work, "flown", "--world 3");
    const Result found = work.succeed("identify", robot, "flown/trajectory.csv --true-motion -o learned.yaml --json");
    const Json json = found.json();
    int learned = 0;
    for (const Json& number : json.at("numbers")) {
        learned += number.at("learned").get<bool>() ? 1 : 0;
        CHECK(number.at("learned").get<bool>() != number.contains("reason"));
    }
    CHECK(learned >= 3);
    const std::string file = work.text("learned.yaml");
    CHECK_THAT(file,
               Contains("learned by `downwash identify`") && Contains("flown/trajectory.csv") && Contains("{mean: "));
    CHECK_THAT(work.succeed("margins learned.yaml").out, Contains("ars_lrm_space"));
    CHECK_THAT(work.succeed("identify", robot, "flown/trajectory.csv --true-motion -o again.yaml").out,
               Contains("stays as it was"));
    CHECK(work.text("again.yaml") == file);
}

TEST_CASE("Flights near the ground give its thrust ratios, which a model is fitted to") {
    const Workspace work;
    Json knots = Json::array();
    const double heights[] = {1.5, 0.5, 0.2, 0.17, 0.3, 0.17, 0.7, 1.5};
    for (int i = 0; i < 8; ++i) {
        knots.push_back(Json{{"t_s", 1.5 * i},
                             {"x_m", 0.3},
                             {"y_m", 0.2},
                             {"z_m", heights[i]},  // level all the time: tilt lowers K
                             {"yaw_rad", 0.3},
                             {"joint_1_rad", -0.3}});  // the arm points up
    }
    write_file(work.in_run("plan.json"),
               Json{{"schema", "downwash/solution/v1"}, {"plan", {{"reference", knots}}}}.dump());
    write_file(work.in_run("floor.yaml"),
               "schema: downwash/problem/v1\nname: floor\nrobot: " + robot +
                   "\nenvironment:\n  bounds: {x_m: [-3, 3], y_m: [-3, 3], z_m: [0.01, 5]}\n  obstacles:\n"
                   "    - {name: floor, box: {size_m: [40, 40, 1], center_m: [0, 0, -0.5]}}\n"
                   "start: {x_m: 0.3, y_m: 0.2, z_m: 1.5, yaw_deg: 17.188733853924695, joints_deg: "
                   "[-17.188733853924695]}\n"
                   "goal: {configuration: {x_m: 0.3, y_m: 0.2, z_m: 1.5, tolerance_m: 0.5}, hold_s: 1}\n");
    static_cast<void>(work.run("execute floor.yaml --plan plan.json --quiet --out flown"));
    const Json found = work.succeed("identify", robot,
                                    "flown/trajectory.csv --true-motion -o learned.yaml --ground 0 --surface-data k.csv"
                                    " --json")
                           .json();
    CHECK(found.at("thrust_ratios").size() >= 3);
    const Json fit = work.succeed("aeromap fit k.csv --model li --surface ground --weighted --json").json();
    CHECK(fit.at("parameters").at("rho").get<double>() == Approx(1).epsilon(0.1));  // Cheeseman and Bennett
}

TEST_CASE("What identify cannot take is refused with a reason") {
    const Workspace work;
    write_file(work.in_run("log.csv"), "t_s,x_m,y_m,z_m\n0,0,0,2\n0.01,0,0,2\n");
    const Result lacking = work.run("identify", robot, "log.csv -o learned.yaml");
    CHECK(lacking.code == 2);
    CHECK_THAT(lacking.err, Contains("has no attitude") && Contains("has no joint torques"));
    const Result planar =
        work.run("identify", std::string(DOWNWASH_PROBLEMS "/robots/ars_lrm.yaml"), "log.csv -o learned.yaml");
    CHECK(planar.code == 2);
    CHECK_THAT(planar.err, Contains("is a robot in a plane"));
    const Result surface = work.run("identify", robot, "log.csv -o learned.yaml --surface-data k.csv");
    CHECK(surface.code == 2);
    CHECK_THAT(surface.err, Contains("--ground Z or --ceiling Z"));
}
