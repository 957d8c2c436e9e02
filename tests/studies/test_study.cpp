#include <catch2/catch.hpp>

#include "downwash/studies/study_files.hpp"

using namespace downwash;
using namespace downwash::studies;

namespace {

Study example() {
    Study study;
    study.name = "example";
    study.title = "An <example> & more";
    study.setting = {"What was flown."};
    study.findings = {{"S1", "crosses", "1 < 2", true, ""}, {"S2", "falls", "stays", false, "gains > 3"}};
    study.figures = {{"one", "A line.", {CurveFigure{}}}};
    study.figures[0].diagrams[0].curves = {{"line", {{0, 0}, {1, 1}}}};
    study.tables = {{"numbers", "Numbers.", {"a", "b [m]"}, {{"x", "1"}, {"y, z", "2"}}}};
    return study;
}

std::string content(const Study& study, const std::string& name) {
    for (const auto& [file, text] : files_of(study)) {
        if (file == name) {
            return text;
        }
    }
    FAIL("no file " << name);
    return {};
}

}  // namespace

TEST_CASE("A study is written as JSON, Markdown, CSV, pictures and one page") {
    const Study study = example();
    CHECK(content(study, "numbers.csv") == "a,b [m]\nx,1\n\"y, z\",2\n");
    CHECK_THAT(content(study, "study.json"), Catch::Contains("\"reproduced\": false"));
    CHECK_THAT(content(study, "study.md"), Catch::Contains("| S2 | falls | stays (gains > 3) | no |"));
    CHECK_THAT(content(study, "one.svg"), Catch::Contains("<svg"));
    const std::string page = content(study, "study.html");
    CHECK_THAT(page, Catch::Contains("An &lt;example&gt; &amp; more"));
    CHECK_THAT(page, Catch::Contains("1 &lt; 2"));
    CHECK_THAT(page, Catch::Contains("<svg"));
    CHECK(page.find("<?xml") == std::string::npos);
    CHECK(page.find("src=") == std::string::npos);  // nothing is fetched
}
