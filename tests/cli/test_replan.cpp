#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "../support/csv_rows.hpp"
#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;

namespace {

/// The numbers of a knot of a plan, its time apart.
std::vector<double> numbers_of(const nlohmann::json& knot) {
    std::vector<double> numbers;
    for (const char* key : {"x_m", "z_m", "arm_rad", "vx_m_s", "vz_m_s", "arm_rate_rad_s", "ax_m_s2", "az_m_s2",
                            "arm_acceleration_rad_s2"}) {
        numbers.push_back(knot.at(key).get<double>());
    }
    return numbers;
}

/// A knot in the middle of a plan.
const nlohmann::json& middle_knot(const nlohmann::json& solution) {
    const auto& knots = solution.at("plan").at("reference");
    REQUIRE(knots.size() > 2);
    return knots.at(knots.size() / 2);
}

}  // namespace

TEST_CASE("replan plans again from a moment of a plan, in a changed problem") {
    const Workspace work;
    const std::string problem = problem_file("bridge_inspection");
    const nlohmann::json solved = work.json("solve", problem, "--max-iterations 200 --out first");
    const auto before = work.files("first");
    const nlohmann::json& knot = middle_knot(solved);
    const double at_s = knot.at("t_s").get<double>();
    const std::string at = "--after=" + knot.at("t_s").dump();

    SECTION("where nothing has changed, it is no worse than the rest of the plan") {
        const nlohmann::json again =
            work.json("replan", problem, "--plan first", at, "--max-iterations 50 --out again");
        CHECK(work.files("first") == before);
        CHECK(work.files("again").size() == files_of_a_run);
        CHECK(again.at("status") == "solved");
        CHECK(again.at("inputs") == solved.at("inputs"));
        const auto& from = again.at("replanned");
        CHECK(from.at("plan") == "first");
        CHECK(from.at("t_s").get<double>() == Approx(at_s));
        CHECK(from.at("rest").at("outcome") == "ok");
        CHECK(again.at("execution").at("cost").get<double>() <= from.at("rest").at("cost").get<double>() * 1.0001);
        // Both plans join: with the same reference, and with the vehicle where the first flight has it.
        const auto& first_knot = again.at("plan").at("reference").at(0);
        CHECK(first_knot.at("t_s") == 0);
        const std::vector<double> joined = numbers_of(first_knot);
        const std::vector<double> left = numbers_of(knot);
        for (std::size_t i = 0; i < joined.size(); ++i) {
            CHECK(joined[i] == Approx(left[i]).margin(1e-9));
        }
        CHECK(std::abs(joined[3]) + std::abs(joined[4]) > 0.01);  // it was on its way
        const auto row =
            rows_of(work.text("first/trajectory.csv")).at(static_cast<std::size_t>(std::llround(at_s / 0.01)));
        const auto start = rows_of(work.text("again/trajectory.csv")).front();
        for (const char* key : {"x_m", "z_m", "pitch_rad", "arm_rad", "vx_m_s", "vz_m_s"}) {
            CHECK(std::stod(start.at(key)) == Approx(std::stod(row.at(key))).margin(1e-9));
        }
    }
    SECTION("around an obstacle that is new, the same each time") {
        const auto& last = solved.at("plan").at("reference").back();
        const double x_m = 0.5 * (knot.at("x_m").get<double>() + last.at("x_m").get<double>());
        const double z_m = 0.5 * (knot.at("z_m").get<double>() + last.at("z_m").get<double>());
        write_file(work.in_run("changed.yaml"),
                   replaced(problem_text("bridge_inspection"), "  obstacles:\n",
                            "  obstacles:\n    - {name: crate, box: {size_m: [0.2, 0.2, 0.2], center_m: [" +
                                std::to_string(x_m) + ", 0, " + std::to_string(z_m) + "]}}\n"));
        const auto replan = [&](const std::string& out) {
            const Result result = work.run("replan changed.yaml --plan first", at,
                                           "--max-iterations 100 --variant mp-arm-da --json --out", out);
            INFO(result.err);
            CHECK((result.code == 0 || result.code == 1));
            return work.text(out + "/trajectory.csv");
        };
        CHECK(replan("one") == replan("two"));
        const auto one = nlohmann::json::parse(work.text("one/solution.json"));
        CHECK(one.at("problem").at("file") == "changed.yaml");
        CHECK_THAT(work.text("one/effective.yaml"), Contains("crate") && Contains("controller_memory"));
    }
    SECTION("and says where it starts and how the plans join") {
        const Result told =
            work.succeed("replan", problem, "--plan first/solution.json", at, "--max-iterations 20 --quiet");
        CHECK_THAT(told.out, Contains("starts") && Contains("of first/solution.json: x ") && Contains("earlier plan") &&
                                 Contains("its rest ends ok here") && Contains("-replanned/"));
        CHECK(work.files("first") == before);
    }
    SECTION("and where nothing but the last hover is left, hovers there") {
        const std::string end = "--after=" + solved.at("plan").at("reference").back().at("t_s").dump();
        const nlohmann::json again =
            work.json("replan", problem, "--plan first", end, "--max-iterations 20 --out again");
        CHECK(again.at("status") == "solved");
        CHECK(again.at("plan").at("reference").size() == 1);
        CHECK(again.at("execution").at("outcome") == "ok");
    }
    SECTION("but not before the plan, where it failed, or in place of it") {
        check_rejected(work.run("replan", problem, "--plan first --after=-1"), "--after is -1: expected 0 to ");
        check_rejected(work.run("replan", problem, "--plan first --after=500"), "where the reference of the plan ends");
        check_rejected(work.run("replan", problem, "--plan first"), "--after");
        check_rejected(work.run("replan", problem, "--plan first --out first", at), "holds the plan itself");
        check_rejected(work.run("replan", problem, "--plan nowhere", at), "nowhere");
        std::string faster = replaced(work.text("first/effective.yaml"), "rate_hz: 100", "rate_hz: 200");
        write_file(work.in_run("faster.yaml"), faster);
        check_rejected(work.run("replan faster.yaml --plan first", at),
                       "robot.controller.rate_hz: is 200: expected 100");
    }
}

TEST_CASE("replan plans again in space, from a vehicle in motion") {
    const Workspace work;
    const std::string girder = DOWNWASH_PROBLEMS "/space/around_a_girder.yaml";
    std::string text = replaced(read_file(girder), "uncertainty: {}\n", "");
    text = replaced(text, "../robots/", DOWNWASH_PROBLEMS "/robots/");
    write_file(work.in_run("girder.yaml"), text);
    const nlohmann::json solved =
        work.json("solve girder.yaml --max-iterations 400 --time-limit 200 --stop-at-first --out first");
    CHECK(solved.at("stops").at("moments").size() > 5);
    // Half a second before a knot, where the first plan may rest.
    const auto tick = static_cast<std::size_t>(std::llround(middle_knot(solved).at("t_s").get<double>() / 0.01)) - 50;
    const auto row = rows_of(work.text("first/trajectory.csv")).at(tick);
    const std::string at = "--after=" + row.at("t_s");
    const auto lower = [&](double by_m) {
        return replaced(text, "center_m: [0, 0, 3.42]", "center_m: [0, 0, " + std::to_string(3.42 - by_m) + "]");
    };
    write_file(work.in_run("lower.yaml"), lower(0.05));

    SECTION("below a flange that turned out to be lower") {
        const nlohmann::json again =
            work.json("replan lower.yaml --plan first", at, "--max-iterations 100 --time-limit 200 --out again");
        CHECK(work.files("again").size() == work.files("first").size());
        CHECK(again.at("status") == "solved");
        const auto& from = again.at("replanned");
        CHECK(from.at("plan") == "first");
        CHECK(from.at("t_s").get<double>() == Approx(std::stod(row.at("t_s"))));
        CHECK(from.at("rest").at("outcome").is_string());
        // Both plans join: with the same reference, and with the vehicle where the first flight has it.
        const auto start = rows_of(work.text("again/trajectory.csv")).front();
        double speed_m_s = 0;
        for (const char* key :
             {"ref_x_m", "ref_y_m", "ref_z_m", "ref_yaw_rad", "ref_joint_2_rad", "x_m", "y_m", "z_m", "qw", "qx", "qy",
              "qz", "joint_1_rad", "vx_m_s", "vy_m_s", "vz_m_s", "wy_rad_s", "joint_3_rate_rad_s"}) {
            CAPTURE(key);
            CHECK(std::stod(start.at(key)) == Approx(std::stod(row.at(key))).margin(1e-9));
        }
        for (const char* key : {"vx_m_s", "vy_m_s", "vz_m_s"}) {
            speed_m_s += std::abs(std::stod(start.at(key)));
        }
        CHECK(speed_m_s > 0.05);  // it was on its way
        // What its controller saw a delay before, and so what it commands, is all that differs.
        CHECK(std::stod(start.at("rotor_1_cmd_n")) == Approx(std::stod(row.at("rotor_1_cmd_n"))).epsilon(0.02));
        CHECK_THAT(work.text("again/effective.yaml"), Contains("controller_memory") && Contains("body_rates_rad_s"));
        // The run stands for itself, and an independent judge agrees.
        work.succeed("validate again/effective.yaml --plan again --quiet");
    }
    SECTION("and says where it starts and how the plans join, the same each time") {
        const Result told =
            work.succeed("replan girder.yaml --plan first/solution.json", at, "--max-iterations 20 --quiet --out one");
        CHECK_THAT(told.out, Contains("starts") && Contains("of first/solution.json: x ") && Contains("deg, ") &&
                                 Contains("its rest ends ok here") && Contains("stops"));
        work.succeed("replan girder.yaml --plan first/solution.json", at, "--max-iterations 20 --quiet --out two");
        CHECK(work.text("one/trajectory.csv") == work.text("two/trajectory.csv"));
    }
    SECTION("but not before the plan, in place of it, or where the start is in collision") {
        check_rejected(work.run("replan girder.yaml --plan first --after=-1"), "--after is -1: expected 0 to ");
        check_rejected(work.run("replan girder.yaml --plan first --out first", at), "holds the plan itself");
        check_rejected(work.run("replan girder.yaml --plan nowhere", at), "nowhere");
        write_file(work.in_run("blocked.yaml"),
                   replaced(text, "  obstacles:\n",
                            "  obstacles:\n    - {name: crate, box: {size_m: [0.2, 0.2, 0.2], center_m: [" +
                                row.at("x_m") + ", " + row.at("y_m") + ", " + row.at("z_m") + "]}}\n"));
        check_rejected(work.run("replan blocked.yaml --plan first", at),
                       "start is in collision with the obstacle 'crate'");
    }
}
