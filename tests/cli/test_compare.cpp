#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;

TEST_CASE("The flight of a run is its own log: no error from it, and the reference's errors as the run says") {
    const Workspace work;
    work.succeed("solve", problem_file("bridge_inspection"), "--max-iterations 300 --quiet --out run");
    const auto solution = nlohmann::json::parse(work.text("run/solution.json"));
    const auto found = work.json("compare run run/trajectory.csv --envelope-worlds 0");
    CHECK(found.at("schema") == "downwash/comparison/v1");
    CHECK(found.at("log").at("format") == "CSV");
    CHECK(found.at("alignment").at("covered").get<double>() == Approx(1).margin(0.002));
    CHECK(std::abs(found.at("alignment").at("offset_s").get<double>()) < 0.01);
    CHECK(found.at("from_planned_flight").at("max_m").at("distance").get<double>() < 0.005);
    const auto& execution = solution.at("execution");
    CHECK(found.at("tracking").at("max_m").at("distance").get<double>() ==
          Approx(execution.at("max_tracking_error_m").get<double>()).margin(0.005));
    CHECK(found.at("clearance").at("flown").at("min_m").get<double>() ==
          Approx(execution.at("min_clearance_m").get<double>()).margin(0.005));
    CHECK(found.at("envelope").is_null());

    const Result text =
        work.succeed("compare run/solution.json run/trajectory.csv --in-world --time-offset 0 --out found");
    CHECK_THAT(text.out, Contains("taken as the problem's world") && Contains("hover") && Contains("thrust"));
    CHECK(work.files("found").size() == (has_pages ? 2 : 1));
    CHECK(nlohmann::json::parse(work.text("found/comparison.json")).at("alignment").at("shift_m") ==
          nlohmann::json({0.0, 0.0, 0.0}));
    if (has_pages) {
        CHECK_THAT(work.text("found/comparison.html"),
                   Contains("downwash/comparison-report/v1") && Contains("--in-world"));
    }

    write_file(work.in_run("cut.ulg"), std::string("ULog\x01\x12\x35", 7));
    check_rejected(work.run("compare run cut.ulg"), "cut.ulg: byte 0: the header ends after 7 bytes");
    check_rejected(work.run("compare run nowhere.ulg"), "nowhere.ulg cannot be read: there is no such file");
    check_rejected(work.run("compare run run/trajectory.csv --column z"), "--column is 'z': expected SIGNAL=NAME");
    check_rejected(work.run("compare run run/trajectory.csv --envelope-worlds 3"), "the problem has no `uncertainty:`");
    std::filesystem::create_directory(work.in_run("alone"));
    write_file(work.in_run("alone/solution.json"), work.text("run/solution.json"));
    check_rejected(work.run("compare alone/solution.json run/trajectory.csv"),
                   "--problem-file says which problem the plan is of");
}
