#include <catch2/catch.hpp>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;
using Catch::StartsWith;

TEST_CASE("A study is run into a folder, reported, and continued") {
    const Workspace work;
    const std::string problem = shipped_file("open_air");
    const char* const rest = "--seeds 1 --time-limit 0.05 --worlds 2 --out out --quiet";
    const Result first = work.succeed("study uncertainty --problem", problem, rest);
    CHECK_THAT(first.out, StartsWith("# Study: uncertainty\n") && Contains("22 of 22 runs done."));
    CHECK(work.text("out/study.md") == first.out);
    const auto json = work.json("study uncertainty --problem", problem, rest);
    CHECK(json.at("study") == "uncertainty");
    CHECK(json.at("findings").size() == 7);
    const Result other =
        work.run("study uncertainty --problem", problem, "--seeds 1 --time-limit 0.05 --worlds 3 --out out");
    CHECK(other.code == 2);
    CHECK_THAT(other.err, Contains("was begun with evaluation_worlds 2, not 3"));
}

TEST_CASE("A study says which problems it cannot use") {
    const Workspace work;
    const Result none = work.run("study uncertainty --out out");
    CHECK(none.code == 2);
    CHECK_THAT(none.err, Contains("there is no problem in the folder problems/"));
    write_file(work.in_run("sure.yaml"), problem_text("open_air"));
    const Result sure = work.run("study uncertainty --problem sure.yaml --out out");
    CHECK(sure.code == 2);
    CHECK_THAT(sure.err, Contains("has no uncertainty to study"));
}

TEST_CASE("The study of awareness needs the problems of the sources") {
    const Workspace work;
    const Result none = work.run("study awareness --estimate");
    CHECK(none.code == 2);
    CHECK_THAT(none.err, Contains("there is no problem in the folder problems/"));
}

TEST_CASE("A study of the thesis' experiments writes findings, numbers, pictures and a page") {
    const Workspace work;
    const Result result = work.succeed("study ceiling-envelope --out out");
    CHECK_THAT(result.out, StartsWith("# Which pitch a vehicle under a ceiling may have"));
    CHECK(work.text("out/study.md") == result.out);
    CHECK_THAT(work.text("out/ceiling_models.csv"), StartsWith("model,10 deg at 0.10 m,"));
    CHECK_THAT(work.text("out/figure_4_9.svg"), Contains("<svg"));
    CHECK_THAT(work.text("out/study.html"), Contains("<svg") && Contains("Findings"));
    const auto json = work.json("study ceiling-envelope --out out");
    CHECK(json.at("study") == "ceiling-envelope");
    for (const auto& finding : json.at("findings")) {
        CHECK(finding.at("reproduced").is_boolean());
        CHECK(!finding.at("thesis").get<std::string>().empty());
        CHECK(!finding.at("measured").get<std::string>().empty());
    }
}
