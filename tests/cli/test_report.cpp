#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>

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
         {std::pair{"csv", "setpoints.csv"}, std::pair{"ros", "trajectory.json"}, std::pair{"qgc", "mission.plan"},
          std::pair{"vtp", "flight.vtp"}, std::pair{"vtp-scene", "scene.vtp"}, std::pair{"glb", "run.glb"}}) {
        CAPTURE(format);
        std::vector<std::string> arguments{"export", solved.directory, "--format", format};
        if (std::string_view(format) == "qgc") {
            arguments.insert(arguments.end(), {"--origin", "47", "-8.5", "400", "--bearing", "90"});
        }
        const Result result = run(solved.folder, arguments);
        CHECK(result.err.empty());
        CHECK(result.code == 0);
        CHECK(result.out == std::string("flown/") + name + "\n");
        CHECK(std::filesystem::file_size(solved.file(name)) > 200);
    }
}

TEST_CASE("Results stand without their page") {
    const ScratchFolder folder;
    std::filesystem::create_directories(folder.path() / "run" / "x" / "report.html");
    const Result result = run(folder, {"solve", problem_file("open_air"), "--max-iterations", "100", "--out", "x"});
    CHECK(result.code == 0);
    CHECK(result.out.starts_with("Solved. "));
}

TEST_CASE("A plan whose flight failed is not handed on unasked") {
    const ScratchFolder folder;
    REQUIRE(run(folder, {"solve", problem_file("bridge_inspection"), "--variant", "mp-arm", "--max-iterations", "1000",
                         "--out", "x"})
                .code == 3);
    const Result refused = run(folder, {"export", "x", "--format", "csv"});
    CHECK(refused.code == 2);
    CHECK_THAT(refused.err, Catch::Contains("its flight ended 'collision'; --anyway"));
    CHECK(run(folder, {"export", "x", "--format", "csv", "--anyway"}).code == 0);
    CHECK(run(folder, {"export", "x", "--format", "glb"}).code == 0);
}

TEST_CASE("A first problem is written, sound and solved, and nothing is replaced") {
    const ScratchFolder folder;
    CHECK(run(folder, {"init"}).out == "my_problem.yaml\nars_lrm.yaml\n");
    CHECK(run(folder, {"check", "my_problem.yaml"}).out == "my_problem.yaml: ok\n");
    CHECK(run(folder, {"solve", "my_problem.yaml", "--max-iterations", "500"}).code == 0);
    const Result again = run(folder, {"init"});
    CHECK(again.code == 2);
    CHECK_THAT(again.err, Catch::Contains("my_problem.yaml is there already"));
    CHECK(run(folder, {"init", "other-1.yaml"}).code == 0);
    const std::string other = read_file(folder.path() / "run/other-1.yaml");
    CHECK_THAT(other, Catch::Contains("\nname: other-1                           # becomes") &&
                          Catch::Contains("#   downwash check other-1.yaml          checks the file"));
    CHECK(run(folder, {"init", "an odd name.yaml"}).code == 0);
    CHECK(run(folder, {"check", "an odd name.yaml", "other-1.yaml"}).code == 0);
}

TEST_CASE("Keys are explained from the table that reads them") {
    const ScratchFolder folder;
    const Result margin = run(folder, {"explain", "safety_margin_m"});
    CHECK(margin.code == 0);
    CHECK(margin.out.starts_with("planner.safety_margin_m\n"));
    CHECK_THAT(margin.out, Catch::Contains("expected: a number in m"));
    CHECK_THAT(run(folder, {"explain", "environment.obstacles[3].name"}).out,
               Catch::Contains("environment.obstacles[].name"));
    CHECK_THAT(run(folder, {"explain", "goal"}).out, Catch::Contains("hold_s"));
    CHECK(run(folder, {"explain", "goal.hold"}).out == run(folder, {"explain", "goal.hold_s"}).out);
    const Result unknown = run(folder, {"explain", "safety_margn_m"});
    CHECK(unknown.code == 2);
    CHECK_THAT(unknown.err, Catch::Contains("did you mean 'safety_margin_m'?"));
}

TEST_CASE("Schemas, manual pages and completions come from the same tables") {
    const ScratchFolder folder;
    for (const char* kind : {"problem", "robot", "campaign"}) {
        const nlohmann::json schema = run(folder, {"check", "--schema", kind}).json();
        CHECK(schema.at("type") == "object");
        CHECK(schema.at("properties").contains("schema"));
    }
    const nlohmann::json problem = run(folder, {"check", "--schema", "problem"}).json();
    const nlohmann::json& seed = problem.at("properties").at("planner").at("properties").at("seed");
    CHECK(seed.at("type") == "integer");
    CHECK(seed.at("minimum") == 0);
    CHECK(seed.at("default") == 1);
    const std::string shown = seed.at("description");  // all that an editor shows of a key
    CHECK(shown == "of every random number of the search\na whole number from 0 to 4294967295; default 1");
    CHECK_THAT(run(folder, {"manual", "aeromap", "plot"}).out,
               Catch::StartsWith(".TH DOWNWASH-AEROMAP-PLOT 1") && Catch::Contains(".SH OPTIONS"));
    CHECK(run(folder, {"manual", "--all", "man"}).code == 0);
    const auto pages = files_in(folder.path() / "run/man");
    CHECK(pages.at("downwash-aeromap-plot.1") == run(folder, {"manual", "aeromap", "plot"}).out);
    CHECK(pages.at("downwash.1") == run(folder, {"manual"}).out);
    CHECK(run(folder, {"manual", "solve", "--all", "man"}).code == 2);
    CHECK(run(folder, {"completion", "fish"}).code == 2);
}

TEST_CASE("Completions offer commands, options, what options take, and files, in bash and zsh") {
    const ScratchFolder folder;
    struct Asked {
        const char* words;  ///< of the command line, quoted for the shell; the last one is completed
        const char* offered;
    };
    const Asked all[] = {
        {"downwash sol", "solve"},
        {"downwash aeromap q", "query"},
        {"downwash solve --see", "--seed"},
        {"downwash solve --variant ''", "mp-arm mp-arm-da mp-arm-ada"},
        {"downwash solve one.yaml --variant mp-arm-d", "mp-arm-da"},
        {"downwash solve one.yaml --variant = mp-arm-a", "mp-arm-ada"},
        {"downwash solve --variant=mp-arm-d", "--variant=mp-arm-da"},
        {"downwash aeromap fit --fix k1 =", ""},
        {"downwash aeromap fit --fix k1 = 0", ""},
        {"downwash solve one.yaml --algorithm =",
         "rrt-star rrt-connect informed-rrt-star bit-star rrt sst kpiece1 est"},
        {"downwash execute --aero o", "on off"},
        {"downwash completion z", "zsh"},
        {"downwash aeromap query --model hayd", "hayden"},
        {"downwash aeromap plot --model hayden l", "li"},
        {"downwash aeromap plot --model hayden li --sur", "--surface"},
        {"downwash aeromap plot --model hayden --surface c", "ceiling"},
        {"downwash aeromap plot one.yaml --what h", "hold"},
        {"downwash export flown --format g", "glb"},
        {"downwash solve o", "one.yaml"},
        {"downwash solve --out o", "one.yaml"},
        {"downwash solve --out=o", "--out=one.yaml"},
        {"downwash solve --out=x", ""},
        {"downwash solve --seed -", ""},
    };
    std::string questions = "ask() { COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); COMPREPLY=(); ";
    questions += "for PREFIX; do :; done; _downwash; echo \"${COMPREPLY[*]}\"; }\n";  // zsh finds files by PREFIX
    questions += "cd '" + (folder.path() / "run").string() + "' && touch one.yaml\n";
    std::string expected;
    for (const Asked& asked : all) {
        questions += std::string("ask ") + asked.words + "\n";
        expected += std::string(asked.offered) + "\n";
    }
    const auto path = [&folder](const char* name) { return (folder.path() / name).string(); };
    // What zsh sets up before it calls a completion that was written for bash.
    const std::string zsh_head = "autoload -U compinit && compinit -u -D\n";
    const std::string zsh_middle = "emulate sh; setopt kshglob noshglob braceexpand\n";
    for (const std::string shell : {"bash", "zsh"}) {
        CAPTURE(shell);
        const bool is_zsh = shell == "zsh";
        std::string script = is_zsh ? zsh_head : "";
        script += run(folder, {"completion", shell}).out;
        script += is_zsh ? zsh_middle : "";
        script += questions;
        write_file(path("script"), script);
        REQUIRE(std::system((shell + " '" + path("script") + "' >'" + path("offered") + "'").c_str()) == 0);
        CHECK(read_file(path("offered")) == expected);
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
        {{"report", "flown", "--width", "800"}, "--width: of which picture?"},
        {{"export", "flown", "--format", "roz"}, "did you mean 'ros'?"},
        {{"export", "flown", "--format", "qgc"}, "give --origin LATITUDE LONGITUDE ALTITUDE"},
        {{"export", "flown", "--format", "csv", "--rate", "0"}, "the rate is 0 Hz"},
        {{"export", "flown", "--format", "glb", "--rate", "5"}, "--rate: the format glb has no set-points"},
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
