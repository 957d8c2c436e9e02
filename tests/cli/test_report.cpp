#include <catch2/catch.hpp>
#include <cstdlib>
#include <sstream>
#include <string>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;
using Catch::StartsWith;

namespace {

/// A workspace with a run in its folder `flown`.
class SolvedWorkspace : public Workspace {
 public:
    SolvedWorkspace() { succeed("solve", problem_file("open_air"), "--max-iterations 200 --out flown"); }
};

}  // namespace

TEST_CASE("Pictures and the page of a run are made again from its files, the page to the byte") {
    const SolvedWorkspace work;
    CHECK(work.succeed("report flown --svg --pdf").out ==
          "flown/flight.svg\nflown/plots.svg\nflown/flight.pdf\nflown/plots.pdf\n");
    CHECK_THAT(work.text("flown/plots.pdf"), StartsWith("%PDF"));
    CHECK(work.run("report flown --png -o figures").out == "figures/flight.png\nfigures/plots.png\n");
    const Result again = work.run("report flown -o page.html");
    if (!has_pages) {
        check_rejected(again, "this build contains no pages");
        return;
    }
    CHECK(again.code == 0);
    CHECK(again.out == "page.html\n");
    CHECK(work.text("page.html") == work.text("flown/report.html"));
}

TEST_CASE("A run is exported in every format, under the usual name") {
    const SolvedWorkspace work;
    for (const auto& [format, name] : {std::pair{"csv", "setpoints.csv"},
                                       {"ros", "trajectory.json"},
                                       {"px4", "px4.json"},
                                       {"px4-csv --bearing -30", "px4.csv"},
                                       {"mavlink", "setpoints.tlog"},
                                       {"qgc --origin 47 -8.5 400 --bearing 90", "mission.plan"},
                                       {"vtp", "flight.vtp"},
                                       {"vtp-scene", "scene.vtp"},
                                       {"glb", "run.glb"}}) {
        CAPTURE(format);
        const Result result = work.succeed("export flown --format", format);
        if (std::string_view(format).starts_with("qgc") || format == std::string_view("mavlink")) {
            CHECK_THAT(result.err, Contains("warning: the plan moves the arm by "));
        } else {
            CHECK(result.err.empty());
        }
        CHECK(result.out == std::string("flown/") + name + "\n");
        CHECK(work.text(std::string("flown/") + name).size() > 200);
    }
}

TEST_CASE("Exported set-points are read back and compared with the plan") {
    const SolvedWorkspace work;
    for (const char* format : {"csv", "ros", "px4", "px4-csv", "mavlink"}) {
        CAPTURE(format);
        work.succeed("export flown -o points --rate 50 --format", format);
        const Result checked = work.succeed("export flown --check points");
        CHECK(checked.err.empty());
        CHECK_THAT(checked.out, StartsWith("The set-points fit the plan.\n") &&
                                    Contains(std::string("format            ") + format + "\n") && Contains("yaw"));
        const auto json = work.succeed("export flown --check points --json").json();
        CHECK(json.at("fits") == true);
        CHECK(json.at("format") == format);
        CHECK(json.at("distances").at(0).at("name") == "position");
        CHECK(json.at("distances").at(0).at("itself").get<double>() < 1e-5);
    }
    const Result turned = work.run("export flown --check points --bearing 90");
    CHECK(turned.code == 3);
    CHECK_THAT(turned.out, StartsWith("The set-points do not fit the plan.\n"));
    CHECK_THAT(turned.err, StartsWith("points: byte 8: position does not fit the plan from 0.000 s on: ") &&
                               Contains("is --bearing another one?"));
    write_file(work.in_run("points"), "t_s,x_m\n0,1\n");
    check_rejected(work.run("export flown --check points"), "points:1: ");
}

TEST_CASE("A plan whose flight failed is not handed on unasked") {
    const Workspace work;
    REQUIRE(work.run("solve", problem_file("bridge_inspection"),
                     "--variant mp-arm-da --check-execution false --max-iterations 600 --out x")
                .code == 3);
    check_rejected(work.run("export x --format csv"), "its flight ended 'collision'; --anyway");
    work.succeed("export x --format csv --anyway");
    work.succeed("export x --format glb");
}

TEST_CASE("A first problem is written, sound and solved, and nothing is replaced") {
    const Workspace work;
    CHECK(work.run("init").out == "my_problem.yaml\nars_lrm.yaml\n");
    CHECK_THAT(work.run("check my_problem.yaml").out, StartsWith("my_problem.yaml: ok\n  ars_lrm: "));
    work.succeed("solve my_problem.yaml --max-iterations 500");
    check_rejected(work.run("init"), "my_problem.yaml exists already");
    work.succeed("init other-1.yaml");
    CHECK_THAT(work.text("other-1.yaml"), Contains("\nname: other-1                           # becomes") &&
                                              Contains("#   downwash check other-1.yaml          checks the file"));
    const std::string odd = "an odd name.yaml";
    work.succeed("init", odd);
    work.succeed("check other-1.yaml", odd);
}

TEST_CASE("Keys are explained from the table that reads them") {
    const Workspace work;
    const Result margin = work.succeed("explain safety_margin_m");
    CHECK_THAT(margin.out, StartsWith("planner.safety_margin_m\n") && Contains("expected: a number in m"));
    CHECK_THAT(work.run("explain environment.obstacles[3].name").out, Contains("environment.obstacles[].name"));
    CHECK_THAT(work.run("explain goal").out, Contains("hold_s"));
    CHECK(work.run("explain goal.hold").out == work.run("explain goal.hold_s").out);
    CHECK_THAT(work.run("explain tolerance_m").out,
               StartsWith("goal.configuration.tolerance_m\ngoal.end_effector.tolerance_m\n"));  // said once
    CHECK_THAT(work.run("explain uncertainty.vehicle.mass_scale").out,
               StartsWith("robot.uncertainty.vehicle.mass_scale\n") && Contains("default:  {sd: 0.02}\n") &&
                   Contains("\nuncertainty.vehicle.mass_scale\n") &&
                   Contains("default:  that of robot.uncertainty, or {sd: 0.02}\n"));
    for (const char* word : {"margin", "Clearance while"}) {
        const Words command{"explain", word};
        CHECK_THAT(work.succeed(command).out,
                   Contains("No key is called") && Contains("planner.safety_margin_m") && Contains("least clearance"));
    }
    // A word finds the names that have it within them, too; but not in the middle of another word.
    CHECK_THAT(work.succeed("explain inertia").out, Contains("robot.arm.inertia_kg_m2") &&
                                                        Contains("robot.multirotor.pitch_inertia_kg_m2") &&
                                                        Contains("parallel-axis rule"));
    CHECK_THAT(work.succeed("explain urdf").out,
               StartsWith("`downwash robot import FILE -o robot.yaml` makes") && Contains("arm.limits_deg"));
    CHECK_THAT(work.succeed("explain thrust_stand").out, Contains("rotors.power_coefficient_w_n1p5"));
    CHECK_THAT(work.succeed("explain y_m").out,
               Contains("No key is called 'y_m': ") && Contains("vertical plane") && !Contains("safety_margin_m"));
    CHECK_THAT(work.succeed("explain goal.end_effector.y_m").out, Contains("environment.plane"));
    check_rejected(work.run("explain safety_margn_m"), "did you mean 'safety_margin_m'?");
    check_rejected(work.run("explain boiler"), "`downwash check --schema problem` prints all keys");
}

TEST_CASE("Schemas, manual pages and completions come from the same tables") {
    const Workspace work;
    for (const char* kind : {"problem", "robot", "campaign"}) {
        const nlohmann::json schema = work.run("check --schema", kind).json();
        CHECK(schema.at("type") == "object");
        CHECK(schema.at("properties").contains("schema"));
    }
    const nlohmann::json robot = work.run("check --schema robot").json();
    const nlohmann::json& own = robot.at("properties").at("uncertainty").at("properties");
    CHECK(own.size() == 2);
    CHECK(own.at("vehicle").at("properties").at("mass_scale").at("default").at("sd") == 0.02);
    CHECK(own.at("sensing").at("properties").contains("pitch_bias_deg"));
    const nlohmann::json problem = work.run("check --schema problem").json();
    const nlohmann::json& seed = problem.at("properties").at("planner").at("properties").at("seed");
    CHECK(seed.at("type") == "integer");
    CHECK(seed.at("minimum") == 0);
    CHECK(seed.at("default") == 1);
    const std::string shown = seed.at("description");  // all that an editor shows of a key
    CHECK_THAT(shown, Catch::EndsWith("\na whole number from 0 to 4294967295; default 1"));
    CHECK_THAT(work.run("manual aeromap plot").out,
               StartsWith(".TH DOWNWASH-AEROMAP-PLOT 1") && Contains(".SH OPTIONS"));
    work.succeed("manual --all man");
    CHECK(work.text("man/downwash-aeromap-plot.1") == work.run("manual aeromap plot").out);
    CHECK(work.text("man/downwash.1") == work.run("manual").out);
    CHECK(work.run("manual solve --all man").code == 2);
    check_rejected(work.run("completion elvish"), "SHELL is 'elvish': expected bash, zsh or fish\n");
    check_rejected(work.run("explain seed --of problm"), "--of is 'problm': expected problem, robot, campaign, ");
    check_rejected(work.run("explain seed --of problm"), "did you mean 'problem'?");
}

TEST_CASE("Completions offer commands, options, what options take, and files, in bash and zsh") {
    const Workspace work;
    struct Asked {
        const char* words;  ///< of the command line, quoted for the shell; the last one is completed
        const char* offered;
    };
    const Asked all[] = {
        {"downwash sol", "solve"},
        {"downwash aeromap q", "query"},
        {"downwash solve --see", "--seed"},
        {"downwash solve --variant ''", "mp-arm|mp-arm-da|mp-arm-ada"},
        {"downwash solve one.yaml --variant mp-arm-d", "mp-arm-da"},
        {"downwash solve one.yaml --variant = mp-arm-a", "mp-arm-ada"},
        {"downwash solve --variant=mp-arm-d", "--variant=mp-arm-da"},
        {"downwash aeromap fit --fix k1 =", ""},
        {"downwash aeromap fit --fix k1 = 0", ""},
        {"downwash solve one.yaml --variant =", "mp-arm|mp-arm-da|mp-arm-ada"},
        {"downwash solve one.yaml --algorithm = in", "informed-rrt-star"},
        {"downwash execute --aero o", "on|off"},
        {"downwash completion z", "zsh"},
        {"downwash aeromap query --model hayd", "hayden"},
        {"downwash aeromap plot --model hayden l", "li"},
        {"downwash aeromap plot --model hayden li --sur", "--surface"},
        {"downwash aeromap plot --model hayden --surface c", "ceiling"},
        {"downwash aeromap plot one.yaml --what h", "hold"},
        {"downwash export flown --format g", "glb"},
        {"downwash solve o", "one.yaml"},
        {"downwash solve tw", "two words.yaml"},
        {"downwash solve th", "three*.yaml"},
        {"downwash solve --out o", "one.yaml"},
        {"downwash solve --out=o", "--out=one.yaml"},
        {"downwash solve --out=x", ""},
        {"downwash solve --seed -", ""},
    };
    // Where there are other files, those that are meant come first, and before options until one is given.
    const Asked with_others[] = {
        {"downwash solve ''", "only.yaml"},
        {"downwash solve n", "notes.txt"},
        {"downwash check o", "only.yaml"},
        {"downwash check t", "table.csv"},
        {"downwash aeromap fit ''", "table.csv"},
        {"downwash replan only.yaml --plan ''", "solution.json"},
        {"downwash replan only.yaml --plan=s", "--plan=solution.json"},
        {"downwash solve only.yaml --no", "--no-cache"},
        {"downwash planners ''", "--help|--json"},
        {"downwash explain planner.sa", "planner.safety_margin_m"},
        {"downwash explain safety", "safety_margin_m"},
    };
    std::string questions = "ask() { COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); COMPREPLY=(); ";
    questions +=
        "for PREFIX; do :; done; _downwash; (IFS='|'; echo \"${COMPREPLY[*]}\"); }\n";  // zsh finds files by PREFIX
    questions += "cd '" + work.in_run().string() + "' && touch one.yaml 'two words.yaml' 'three*.yaml'\n";
    std::string expected;
    for (const Asked& asked : all) {
        questions += std::string("ask ") + asked.words + "\n";
        expected += std::string(asked.offered) + "\n";
    }
    questions += "mkdir -p ../others && cd ../others && touch only.yaml table.csv solution.json notes.txt\n";
    for (const Asked& asked : with_others) {
        questions += std::string("ask ") + asked.words + "\n";
        expected += std::string(asked.offered) + "\n";
    }
    // What zsh sets up before it calls a completion that was written for bash.
    const std::string zsh_head = "autoload -U compinit && compinit -u -D\n";
    const std::string zsh_middle = "emulate sh; setopt kshglob noshglob braceexpand\n";
    for (const std::string shell : {"bash", "zsh"}) {
        CAPTURE(shell);
        const bool is_zsh = shell == "zsh";
        write_file(work / "script", (is_zsh ? zsh_head : "") + work.run("completion", shell).out +
                                        (is_zsh ? zsh_middle : "") + questions);
        const std::string command = shell + " '" + (work / "script").string() + "' >'";
        REQUIRE(std::system((command + (work / "offered").string() + "'").c_str()) == 0);
        CHECK(read_file(work / "offered") == expected);
    }
}

TEST_CASE("Completions for fish offer commands, options and what options take") {
    const Workspace work;
    const std::string script = work.run("completion fish").out;
    const std::string in_solve = "complete -c downwash -n 'test (__downwash_command) = \"downwash solve\"' ";
    CHECK_THAT(script,
               Contains("complete -c downwash -n 'test (__downwash_command) = \"downwash\"' -f -a 'solve' -d ") &&
                   Contains(in_solve + "-l seed -r -d ") &&
                   Contains(in_solve + "-l variant -r -f -a 'mp-arm mp-arm-da mp-arm-ada' -d ") &&
                   Contains("\"downwash aeromap plot\"") && Contains(in_solve + "-l out -s o -r "));
    if (std::system("command -v fish >/dev/null") != 0) {
        return;
    }
    write_file(work / "script", script + R"(
complete -C 'downwash sol'
complete -C 'downwash aeromap q'
complete -C 'downwash solve --see'
complete -C 'downwash solve --variant mp-arm-d'
complete -C 'downwash completion fi'
complete -C 'downwash solve ' | head -1
complete -C 'downwash replan b.yaml --plan ' | head -1
)");
    for (const char* file : {"a.txt", "b.yaml", "c.json"}) {
        write_file(work.in_run(file), "");
    }
    REQUIRE(std::system(("cd '" + work.in_run().string() + "' && HOME='" + work.path().string() + "' fish -N '" +
                         (work / "script").string() + "' >'" + (work / "offered").string() + "'")
                            .c_str()) == 0);
    std::istringstream lines(read_file(work / "offered"));
    std::string words;
    for (std::string line; std::getline(lines, line);) {
        words += line.substr(0, line.find('\t')) + "|";
    }
    CHECK(words == "solve|query|--seed|mp-arm-da|fish|b.yaml|c.json|");
}

TEST_CASE("What cannot be reported or exported is rejected with a remedy") {
    const SolvedWorkspace work;
    for (const auto& [arguments, reason] :
         {std::pair{"report elsewhere --svg", "elsewhere: there is no such folder"},
          {"report flown --svg --width 10", "--width"},
          {"report flown --width 800", "--width goes with pictures only"},
          {"report flown --no-labels", "--no-labels goes with pictures only"},
          {"export flown --format roz", "did you mean 'ros'?"},
          {"export flown --format qgc", "give --origin LATITUDE LONGITUDE ALTITUDE"},
          {"export flown --format csv --rate 0", "the rate is 0 Hz"},
          {"export flown --format qgc --origin 47 8 400 --end rest", "expected hover, land or return"},
          {"export flown --format glb --end land", "--end: the format glb is no mission"},
          {"export flown --format glb --rate 5", "--rate: the format glb has no set-points"},
          {"export flown --check x.csv --rate 5", "--rate: --check writes nothing"},
          {"export flown --check x.csv", "x.csv cannot be read"},
          {"export flown --format csv --json", "--json: expected --check"},
          {"export flown", "--format"}}) {
        CAPTURE(arguments);
        check_rejected(work.run(arguments), reason);
    }
    write_file(work.in_run("flown/trajectory.csv"), "t_s,x_m\n1,2\n");
    check_rejected(work.run("export flown --format vtp"), "trajectory.csv:1: there is no column 'ref_x_m'");
}
