#include <catch2/catch.hpp>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test

namespace {

/// A folder with a run in it.
class Run {
 public:
    Run() {
        REQUIRE(run(folder, {"solve", problem_file("open_air"), "--max-iterations", "200", "--out", directory}).code ==
                0);
    }

    /// A file of the run.
    [[nodiscard]] std::filesystem::path file(const std::string& name) const { return work() / directory / name; }
    /// Where commands run.
    [[nodiscard]] std::filesystem::path work() const { return folder.path() / "run"; }

    ScratchFolder folder;
    std::string directory = "flown";
};

}  // namespace

TEST_CASE("Pictures of a run go into its folder or another") {
    const Run solved;
    const Result here = run(solved.folder, {"report", solved.directory, "--svg", "--pdf"});
    CHECK(here.code == 0);
    CHECK(here.out == "flown/flight.svg\nflown/plots.svg\nflown/flight.pdf\nflown/plots.pdf\n");
    CHECK(read_file(solved.file("plots.pdf")).starts_with("%PDF"));
    std::filesystem::create_directory(solved.work() / "figures");
    CHECK(run(solved.folder, {"report", solved.directory, "--png", "-o", "figures"}).out ==
          "figures/flight.png\nfigures/plots.png\n");
}

TEST_CASE("A page is made again from the files of a run, to the byte") {
    const Run solved;
    const auto page = solved.file("report.html");
    const Result again = run(solved.folder, {"report", solved.directory, "-o", "page.html"});
    if (!std::filesystem::exists(page)) {
        CHECK(again.code == 2);  // a build without its viewer
        CHECK_THAT(again.err, Catch::Contains("this build brings no pages"));
        return;
    }
    CHECK(again.code == 0);
    CHECK(again.out == "page.html\n");
    CHECK(read_file(solved.work() / "page.html") == read_file(page));
}

TEST_CASE("A run is exported in every format, under the usual name") {
    const Run solved;
    for (const auto& [format, name] :
         {std::pair{"csv", "run.csv"}, std::pair{"ros", "run.json"}, std::pair{"qgc", "run.plan"},
          std::pair{"vtp", "run.vtp"}, std::pair{"vtp-scene", "run.vtp"}, std::pair{"glb", "run.glb"}}) {
        CAPTURE(format);
        const Result result =
            run(solved.folder, {"export", solved.directory, "--format", format, "--origin", "47", "-8.5", "400"});
        CHECK(result.err.empty());
        CHECK(result.code == 0);
        CHECK(result.out == std::string("flown/") + name + "\n");
        CHECK(std::filesystem::file_size(solved.file(name)) > 200);
    }
}

TEST_CASE("What cannot be reported or exported is refused with a remedy") {
    const Run solved;
    struct Refused {
        std::vector<std::string> arguments;
        const char* message;
    };
    const Refused all[] = {
        {{"report", "elsewhere", "--svg"}, "elsewhere: there is no such folder"},
        {{"report", "flown", "--svg", "--width", "10"}, "--width"},
        {{"report", "flown", "--svg", "-o", "nowhere"}, "nowhere/flight.svg"},
        {{"export", "flown", "--format", "roz"}, "did you mean 'ros'?"},
        {{"export", "flown", "--format", "qgc"}, "give --origin LATITUDE LONGITUDE ALTITUDE"},
        {{"export", "flown", "--format", "csv", "--rate", "0"}, "the rate is 0 Hz"},
        {{"export", "flown"}, "--format"},
    };
    for (const Refused& refused : all) {
        CAPTURE(refused.message);
        const Result result = run(solved.folder, refused.arguments);
        CHECK(result.code == 2);
        CHECK_THAT(result.err, Catch::Contains(refused.message));
        CHECK(result.out.empty());
    }
    write_file(solved.file("trajectory.csv"), "t_s,x_m\n1,2\n");
    const Result broken = run(solved.folder, {"export", "flown", "--format", "vtp"});
    CHECK(broken.code == 2);
    CHECK_THAT(broken.err, Catch::Contains("trajectory.csv:1: there is no column 'ref_x_m'"));
}
