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
