#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;

namespace {

/// The open air with such a ground model, in a file.
std::string problem_with(const ScratchFolder& folder, const std::string& ground) {
    const std::string shipped = problem_file("open_air");
    const std::string robot = (std::filesystem::path(shipped).parent_path() / "robots/ars_lrm.yaml").string();
    std::string text = read_file(shipped);
    text.replace(text.find("robots/ars_lrm.yaml"), std::string("robots/ars_lrm.yaml").size(), robot);
    write_file(folder / "problem.yaml", text + "aero: {ground: {model: " + ground + "}}\n");
    return folder / "problem.yaml";
}

}  // namespace

TEST_CASE("A grid built where a fountain pushes the body says that it lacks it") {
    const ScratchFolder folder;
    const auto build = [&](const std::string& ground, const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments{"aeromap", "build", problem_with(folder, ground), "-o", folder / "grid.csv",
                                           "--step",  "0.5"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(folder, arguments);
    };
    const std::string line = "# fountain: not contained: the grid holds the factors of rotors\n";
    const Result loud = build("multirotor-body");
    CAPTURE(loud.err);
    CHECK(loud.code == 0);
    CHECK_THAT(loud.err, Contains("the fountain that pushes the body is not contained"));
    CHECK_THAT(read_file(folder / "grid.csv"), Contains(line));
    CHECK(build("multirotor-body", {"--quiet", "--lateral", "-1", "1"}).err.empty());
    CHECK_THAT(read_file(folder / "grid.csv"), Contains(line));
    CHECK_THAT(build("multirotor-images").err, !Contains("fountain"));
    CHECK_THAT(read_file(folder / "grid.csv"), !Contains("fountain"));
}

TEST_CASE("A grid that cannot be written is refused before it is built") {
    const ScratchFolder folder;
    // Neither problem exists: the output comes first.
    const Result wrong = run(folder, {"aeromap", "build", "nowhere.yaml", "-o", "grid.txt"});
    CHECK(wrong.code == 2);
    CHECK(wrong.err == "downwash: grid.txt ends in '.txt': expected .vti (VTK ImageData) or .csv\n");
    const Result nowhere = run(folder, {"aeromap", "build", "nowhere.yaml", "-o", "no/such/folder/grid.vti"});
    CHECK(nowhere.code == 2);
    CHECK_THAT(nowhere.err, Contains("no/such/folder/grid.vti cannot be written"));
    CHECK(run(folder, {"aeromap", "build", "nowhere.yaml", "-o", "grid.vti"}).code == 2);
    CHECK(files_in(folder.path() / "run").empty());
}

TEST_CASE("Any bytes in a file become JSON that can be read") {
    const ScratchFolder folder;
    write_file(folder / "grid.csv", "# note: \xff!\nx_m,z_m,factor\n0,0,1\n1,0,1\n0,1,1\n1,1,1\n");
    const Result result = run(folder, {"aeromap", "info", folder / "grid.csv", "--json"});
    CAPTURE(result.err);
    REQUIRE(result.code == 0);
    CHECK(result.json().at("provenance").at(0).at("value") == "\xef\xbf\xbd!");
    write_file(folder / "data.csv", "source,surface,z_over_r,thrust_ratio\nb\xff,ground,0.5,1.3\nb\xff,ground,1,1.1\n");
    const Result comparison = run(folder, {"aeromap", "compare", folder / "data.csv", "--json"});
    CAPTURE(comparison.err);
    REQUIRE(comparison.code == 0);
    CHECK_FALSE(comparison.json().empty());
}

TEST_CASE("Points that are none are refused") {
    const ScratchFolder folder;
    const auto query = [&](const std::string& points) {
        return run(folder, {"aeromap", "query", problem_file("open_air"), "--no-cache", "--points", points});
    };
    const Result directory = query(folder.path().string());
    CHECK(directory.code == 2);
    CHECK_THAT(directory.err, EndsWith(": is a directory, expected a file\n"));
    write_file(folder / "points.txt", "x_m,y_m,z_m\n# nothing\n\n");
    const Result nothing = query(folder / "points.txt");
    CHECK(nothing.code == 2);
    CHECK_THAT(nothing.err, EndsWith(": holds no point, expected lines of three numbers, x_m y_m z_m\n"));
    write_file(folder / "points.txt", "x_m,y_m,z_m\n0,0,3 # one\n");
    CHECK(query(folder / "points.txt").code == 0);
}
