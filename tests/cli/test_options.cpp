#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <tuple>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;
using Catch::StartsWith;

namespace {

struct Option {
    std::string command, short_form, meaning;
};

/// Every option of every command by its long name, as the manual lists them.
std::map<std::string, std::vector<Option>> all_options(const Workspace& work) {
    std::map<std::string, std::vector<Option>> options;
    std::istringstream lines(work.succeed("manual --markdown").out);
    const std::regex row("\\| `(?:(-[a-z]),)?(--[a-z-]+)[^`]*` \\| ([^;]*)[^|]*\\|");
    std::string command;
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("## downwash ", 0) == 0) {
            command = line.substr(12);
        }
        if (std::smatch found; std::regex_search(line, found, row)) {
            std::string meaning = found[3];
            meaning = std::regex_replace(meaning, std::regex(" *(\\(required\\))? *$"), "");
            options[found[2]].push_back({command, found[1], meaning});
        }
    }
    return options;
}

/// The reason for which a command line is rejected, without the lines that follow.
std::string reason(const Workspace& work, const Words& arguments) {
    const Result result = work.run(arguments);
    CHECK(result.code == 2);
    CHECK(result.out.empty());
    return result.err.substr(0, result.err.find('\n'));
}

}  // namespace

TEST_CASE("An option has the same meaning and the same short form in every command") {
    const Workspace work;
    const auto options = all_options(work);
    REQUIRE(options.size() > 40);
    for (const auto& [name, commands] : options) {
        for (const Option& option : commands) {
            INFO(name << " of " << commands.front().command << " and of " << option.command);
            CHECK(option.short_form == commands.front().short_form);
            CHECK(option.meaning == commands.front().meaning);
        }
    }
}

TEST_CASE("What several commands do has one name in all of them") {
    const Workspace work;
    const auto options = all_options(work);
    const std::vector<std::pair<std::string, std::set<std::string>>> expected{
        {"--out",
         {"solve",
          "execute",
          "validate",
          "aeromap build",
          "aeromap plot",
          "aeromap fit",
          "compare",
          "bench run",
          "bench slurm",
          "bench parallel",
          "bench report",
          "study uncertainty",
          "study awareness",
          "study partial-ground-effect",
          "study disturbance-test-bench",
          "study ceiling-envelope",
          "study ceiling-contact",
          "report",
          "export",
          "replan",
          "identify",
          "robot import",
          "robot show",
          "robot thrust"}},
        {"--quiet",
         {"solve", "execute", "validate", "compare", "aeromap query", "aeromap build", "aeromap plot", "bench run",
          "study uncertainty", "study awareness", "study partial-ground-effect", "study disturbance-test-bench",
          "study ceiling-envelope", "study ceiling-contact", "replan"}},
        {"--threads",
         {"solve", "execute", "validate", "compare", "aeromap query", "aeromap build", "aeromap hold", "report",
          "replan"}},
        {"--margin", {"solve", "execute", "replan"}},
        {"--jobs", {"bench run", "bench slurm", "bench parallel", "study uncertainty", "study awareness"}},
        {"--plan", {"execute", "validate", "replan"}},
        {"--arm-deg", {"aeromap plot", "aeromap hold"}},
        {"--no-cache", {"solve", "replan", "aeromap query", "bench run", "study uncertainty", "study awareness"}}};
    for (const auto& [name, commands] : expected) {
        INFO(name);
        REQUIRE(options.contains(name));
        std::set<std::string> found;
        for (const Option& option : options.at(name)) {
            found.insert(option.command);
        }
        CHECK(found == commands);
    }
    for (const char* former : {"--output", "--plot", "--file"}) {
        CHECK_FALSE(options.contains(former));
    }
}

TEST_CASE("An error in an option names it and its value and says what was expected") {
    const Workspace work;
    const std::string open_air = problem_file("open_air");
    CHECK_THAT(reason(work, words("solve", open_air, "--sead 1")),
               Contains("downwash solve has no option --sead") && Contains("did you mean '--seed'?"));
    CHECK_THAT(reason(work, words("aeromap plot", open_air, "--output map.svg")),
               Contains("no option --output") && Contains("did you mean '--out'?"));
    CHECK_THAT(reason(work, words("--vresion")), Contains("did you mean '--version'?"));
    CHECK_THAT(reason(work, words("solve", open_air, "--threads many")),
               Contains("--threads is 'many': expected 1 to 256; --threads N: number of threads, 1 to 256"));
    CHECK_THAT(reason(work, words("solve", open_air, "--threads 0")),
               Contains("--threads is '0': expected 1 to 256; --threads N: number of threads"));
    CHECK_THAT(reason(work, words("solve")), Contains("PROBLEM is required: expected PROBLEM: problem file"));
    CHECK_THAT(reason(work, words("execute", open_air)), Contains("--plan is required: expected --plan FILE"));
    CHECK_THAT(reason(work, words("solve", open_air, "--seed")), Contains("--seed") && Contains("expected --seed N"));
    CHECK_THAT(reason(work, words("solve", open_air, open_air)), Contains("expected downwash solve [OPTIONS] PROBLEM"));
    // What follows -- is no option.
    CHECK_THAT(reason(work, words("check -- --bogus")), Contains("--bogus"));
}

TEST_CASE("Weights of several objectives can be given on the command line") {
    const Workspace work;
    const std::string open_air = problem_file("open_air");
    const auto solution = work.json("solve", open_air, "--max-iterations 50 --objective energy=1,time=50");
    CHECK(solution.at("objective") == nlohmann::json{{"energy", 1}, {"time", 50}});
    CHECK_THAT(reason(work, words("solve", open_air, "--objective energy=1,tmie=50")),
               Contains("--objective is 'energy=1,tmie=50'") && Contains("did you mean 'time'?"));
    for (const char* wrong : {"energy=", "energy=-1", "energy=1,energy=2", "energy=nan", "=1", ",", "time=1,"}) {
        CHECK_THAT(reason(work, words("solve", open_air, "--objective", std::string(wrong))),
                   StartsWith("downwash: --objective is"));
    }
    CHECK_THAT(reason(work, words("solve", open_air, "--objective energy=0,time=0")), Contains("no weight above 0"));
}

TEST_CASE("A plan may be given as its folder and a run as its file") {
    const Workspace work;
    const std::string open_air = problem_file("open_air");
    work.succeed("solve", open_air, "--max-iterations 50 --seed 1 --quiet --out made");
    const Result executed =
        work.succeed("execute", open_air, "--plan made --quiet --threads 1 --margin 0.01 -o executed --json");
    CHECK(executed.err.empty());
    CHECK(executed.json().at("execution").at("outcome") == "ok");
    CHECK_THAT(work.text("executed/effective.yaml"), Contains("safety_margin_m: 0.01"));
    CHECK(work.succeed("validate", open_air, "--plan made").code == 0);
    CHECK(work.succeed("export made/solution.json --format csv -o a.csv").code == 0);
    CHECK(work.succeed("export made --format csv -o b.csv").code == 0);
    CHECK(work.text("a.csv") == work.text("b.csv"));
    // A plan given as its folder is not replaced either.
    CHECK_THAT(reason(work, words("execute", open_air, "--plan made --out made")), Contains("holds the plan itself"));
}

TEST_CASE("The arm is at the angle of the start unless told otherwise and never beyond its limits") {
    const Workspace work;
    const std::string file = work / "limited.yaml";
    write_file(file, problem_text("open_air"));
    const double start_deg = work.json("aeromap hold", file, "--at 0 5").at("arm_deg");
    CHECK(start_deg == Approx(90));
    write_file(work / "robot.yaml", replaced(read_file(DOWNWASH_PROBLEMS "/robots/ars_lrm_ideal.yaml"),
                                             "limits_deg: null", "limits_deg: [30, 150]"));
    write_file(file, std::regex_replace(problem_text("open_air"), std::regex("robot: [^\n]*"), "robot: robot.yaml"));
    CHECK_THAT(reason(work, words("aeromap hold", file, "--at 0 5 --arm-deg 0")), Contains("expected 30 to 150"));
    CHECK_THAT(reason(work, words("aeromap plot", file, "--what hold --arm-deg 0 -o hold.svg")),
               Contains("expected 30 to 150"));
}

TEST_CASE("Check warns of what is likely not meant and the exit code stays 0") {
    const Workspace work;
    const std::string robot = read_file(DOWNWASH_PROBLEMS "/robots/ars_lrm.yaml");
    const std::string file = work / "robot.yaml";
    for (const auto& [part, by, key] :
         {std::tuple{"time_constant_s: 0.05", "time_constant_s: 0.4", "controller"},
          {"radius_m: 0.1905", "radius_m: 0.33", "rotors.positions_m"},
          {"[-0.32, -0.32, 0.06]]", "[-0.32, -0.30, 0.06]]", "rotors.positions_m"},  // rolls
          {"power_coefficient_w_n1p5: 3.154", "power_coefficient_w_n1p5: 3154", "rotors.power_coefficient_w_n1p5"},
          {"rate_kp: 14", "rate_kp: 0", "controller.attitude.rate_kp"}}) {
        CAPTURE(by);
        write_file(file, replaced(robot, part, by));
        const auto warnings = work.json("check", file).at("warnings");
        const auto names_key = [wanted = std::string(key)](const auto& warning) {
            return warning.at("message").template get<std::string>().rfind(wanted + " ", 0) == 0;
        };
        REQUIRE(std::count_if(warnings.begin(), warnings.end(), names_key) == 1);
        const auto& warning = *std::find_if(warnings.begin(), warnings.end(), names_key);
        CHECK(warning.at("file") == file);
        CHECK(warning.at("line").get<int>() > 1);
    }
    const std::string problem = work / "problem.yaml";
    write_file(problem, problem_text("bridge_inspection") + "planner: {safety_margin_m: 0}\n");
    const Result people = work.succeed("check", problem);
    CHECK_THAT(people.out, StartsWith(problem + ": ok, 1 warning\n"));
    CHECK_THAT(people.err, Contains("warning: planner.safety_margin_m is 0"));
    CHECK_THAT(work.run("solve", problem, "--variant mp-arm --max-iterations 1").err,
               Contains("warning: planner.safety_margin_m is 0"));
}

TEST_CASE("Warnings stand in the solution, and those of its problems are a campaign's, each once") {
    const Workspace work;
    for (const char* name : {"one", "other"}) {
        std::string text = replaced(problem_text("open_air"), "name: open_air", std::string("name: ") + name);
        text = std::regex_replace(text, std::regex("robot: [^\n]*"), "robot: robot.yaml");
        write_file(work / (std::string(name) + ".yaml"), text);
    }
    write_file(work / "robot.yaml", replaced(read_file(DOWNWASH_PROBLEMS "/robots/ars_lrm_ideal.yaml"),
                                             "power_coefficient_w_n1p5: 3.154", "power_coefficient_w_n1p5: 3154"));
    const auto expected = work.json("check", work / "one.yaml").at("warnings");
    REQUIRE(expected.size() == 1);
    CHECK(work.json("check", work / "one.yaml", work / "other.yaml").at("warnings") == expected);
    const Result solved = work.run("solve", work / "one.yaml", "--max-iterations 20 --quiet --json --out out");
    CHECK(solved.json().at("warnings") == expected);

    const std::string campaign = work / "campaign.yaml";
    write_file(campaign,
               "schema: downwash/campaign/v1\nname: trial\nproblems: [one.yaml, other.yaml]\nvariants: [mp-arm]\n"
               "seeds: {first: 1, count: 1}\nmax_iterations: 1\n");
    CHECK(work.json("check", campaign).at("warnings") == expected);
    const std::string warning = "warning: rotors.power_coefficient_w_n1p5 is";
    CHECK_THAT(work.run("bench run", campaign, "--out results").err, Contains(warning));
    CHECK(work.run("bench run", campaign, "--out quiet --quiet").err.empty());
}

TEST_CASE("No shipped problem or robot warns and campaigns are checked too") {
    const Workspace work;
    for (const auto& folder :
         {std::filesystem::path(DOWNWASH_PROBLEMS), std::filesystem::path(DOWNWASH_PROBLEMS) / "robots",
          std::filesystem::path(DOWNWASH_PROBLEMS).parent_path() / "bench" / "campaigns"}) {
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            if (entry.path().extension() == ".yaml") {
                CAPTURE(entry.path());
                const auto found = work.json("check", entry.path());
                CHECK(found.at("faults") == nlohmann::json::array());
                CHECK(found.at("warnings") == nlohmann::json::array());
                for (const auto& geometry : found.at("geometry")) {
                    CHECK(geometry.at("surface") == "solid");
                }
            }
        }
    }
}

TEST_CASE("Check tells what became of meshes and octrees in the world, and solve warns of the same") {
    const Workspace work;
    const auto shipped = work.json("check", shipped_file("girder_mesh")).at("geometry");
    REQUIRE(shipped.size() == 4);
    CHECK(shipped[0].at("key") == "environment.obstacles[2]");
    CHECK(shipped[0].at("obstacle") == "left_girder");
    CHECK(shipped[0].at("kind") == "mesh");
    CHECK(shipped[0].at("pieces") == 11);  // the girder and its stiffeners
    CHECK(shipped[0].at("open_place").is_null());
    CHECK(shipped[0].at("low_m").at(0).get<double>() == Approx(-8.9));
    CHECK(shipped[0].at("high_m").at(2).get<double>() == Approx(10));
    CHECK(shipped[3].at("kind") == "octree");
    CHECK(shipped[3].at("cubes").get<int>() > 1000);
    CHECK(shipped[3].at("pieces") == 1);
    CHECK_THAT(work.succeed("check", shipped_file("girder_mesh")).out,
               Contains(" of 164 triangles, 11 pieces, solid, x -8.9 to 3.1 m, y ") && Contains("  pier: octree of "));

    // A wall of two triangles with y up, in millimetres.
    write_file(work / "wall.obj", "v 3000 0 40000\nv 3000 0 42000\nv 3000 3000 42000\nv 3000 3000 40000\nf 1 2 3 4\n");
    const std::string file = work / "wall.yaml";
    write_file(file, std::regex_replace(problem_text("open_air"), std::regex("(    - \\{name: ground)"),
                                        "    - {name: wall, mesh: {file: wall.obj, center_m: [0, 41, 0]}}\n$1"));
    const auto found = work.json("check", file);
    REQUIRE(found.at("geometry").size() == 1);
    const auto& wall = found.at("geometry").at(0);
    CHECK(wall.at("problem") == file);
    CHECK(wall.at("surface") == "sheet");
    CHECK(wall.at("triangles") == 2);
    CHECK(wall.at("open_edges") == 4);
    CHECK(wall.at("open_place").size() == 3);
    CHECK(wall.at("high_m") == nlohmann::json{3000., 3041., 42000.});
    REQUIRE(found.at("warnings").size() == 2);
    CHECK_THAT(found.at("warnings").at(0).at("message"), Contains("is open at 4 edges"));
    CHECK_THAT(found.at("warnings").at(1).at("message"),
               Contains("near with `scale: 0.001` (3 m long)") && Contains(" and `rpy_deg: [90, 0, 0]`"));
    const Result solved = work.run("solve", file, "--max-iterations 1 --quiet --json --out out");
    CHECK(solved.json().at("warnings") == found.at("warnings"));
    CHECK_THAT(work.run("solve", file, "--max-iterations 1 --out out").err,
               Contains("warning: environment.obstacles[0].mesh.file"));
}
