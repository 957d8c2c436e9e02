#include <catch2/catch.hpp>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;

TEST_CASE("A validation is written to a folder, as it is printed and as a page") {
    const Workspace work;
    const std::string text = problem_text("bridge_inspection");
    // The plan is made without worlds, which is quick, and validated in some.
    write_file(work.in_run("believed.yaml"), text);
    write_file(work.in_run("uncertain.yaml"), replaced(text, "uncertainty: none", "uncertainty: {}"));
    work.succeed("solve believed.yaml --max-iterations 300 --quiet --out run");

    const std::size_t files = work.files().size();
    const Words command = words("validate uncertain.yaml --plan run --runs 12 --quiet --json");
    const Result printed = work.succeed(command);
    CHECK(work.files().size() == files);  // nothing is written
    const Result written = work.succeed(command, "--out found");
    CHECK(written.out == printed.out);
    CHECK(work.text("found/validation.json") == printed.out);
    CHECK(work.files("found").size() == (has_pages ? 2 : 1));
    if (has_pages) {
        CHECK_THAT(work.text("found/validation.html"),
                   Contains("downwash/validation-report/v1") && Contains("--runs 12 --seed 1"));
    }

    SECTION("for one flight, too, beside the plan") {
        work.succeed("validate believed.yaml --plan run --quiet --out run");
        const auto found = nlohmann::json::parse(work.text("run/validation.json"));
        CHECK(found.at("outcome") == "ok");
        CHECK_FALSE(found.contains("runs"));
    }
}
