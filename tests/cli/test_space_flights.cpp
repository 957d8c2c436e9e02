#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "program.hpp"

// References in space, flown by `execute` and `validate`, and what other commands say of such problems.

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;
using Json = nlohmann::json;

namespace {

const std::string girder = DOWNWASH_PROBLEMS "/space/around_a_girder.yaml";
const std::string reference = DOWNWASH_PROBLEMS "/space/around_a_girder.json";

/// The shipped reference with some of its knots, from the first on, and changes to it.
template <class Edit>
std::string edited_reference(std::size_t knots, const Edit& edit) {
    Json document = Json::parse(read_file(reference));
    Json& list = document["plan"]["reference"];
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(knots), list.end());
    edit(list);
    return document.dump(1);
}

}  // namespace

TEST_CASE("A reference in space is executed, validated and executed again") {
    const Workspace work;
    const Result flown = work.succeed("execute", girder, "--plan", reference, "--out one");
    CHECK_THAT(flown.out, Catch::StartsWith("The flight with direct aerodynamics ") && Contains("min. clearance") &&
                              Contains("one/{solution.json, trajectory.csv, effective.yaml"));
    CHECK(flown.err.empty());
    const auto files = work.files("one");
    CHECK(files.size() == 3 + (files.count("report.html") > 0 ? 1 : 0));
    const Json solution = Json::parse(files.at("solution.json"));
    CHECK(solution.at("status") == "solved");
    CHECK(solution.at("execution").at("outcome") == "ok");
    CHECK(solution.at("execution").at("aero") == true);
    CHECK(solution.at("inputs").at("robot").at("joints") == 3);

    // The same bytes each time, also from what a run wrote.
    work.succeed("execute", girder, "--plan", reference, "--out two");
    for (const char* name : {"solution.json", "trajectory.csv", "effective.yaml"}) {
        CHECK(work.text(std::string("two/") + name) == files.at(name));
    }
    work.succeed("execute one/effective.yaml --plan one --out three");
    CHECK(work.text("three/trajectory.csv") == files.at("trajectory.csv"));

    const Result judged = work.succeed("validate", girder, "--plan one --json");
    CHECK(judged.json().at("outcome") == "ok");
    CHECK(judged.json().at("disagreements").empty());
    CHECK(judged.json().at("min_clearance_m").get<double>() ==
          Approx(solution.at("execution").at("min_clearance_m").get<double>()).margin(1e-3));
    CHECK_THAT(work.succeed("validate one/effective.yaml --plan one/solution.json").out,
               Catch::StartsWith("Valid. ") && Contains(", as the file says."));
    CHECK_THAT(work.succeed("validate", girder, "--plan", reference).out, Contains("says nothing about a flight"));

    // In free air, and in a world, both of which the judge flies as the file says.
    work.succeed("execute", girder, "--plan", reference, "--aero off --out off");
    CHECK(work.json("validate", girder, "--plan off").at("disagreements").empty());
    CHECK(work.run("execute", girder, "--plan", reference, "--world 3 --seed 9 --out third").code == 0);
    CHECK(Json::parse(work.text("third/solution.json")).at("execution").at("world") == Json{{"index", 3}, {"seed", 9}});
    CHECK(work.text("third/trajectory.csv") != files.at("trajectory.csv"));
    CHECK(work.json("validate", girder, "--plan third").at("disagreements").empty());

    // Without --out, beside the plan, and never over it.
    work.succeed("execute", girder, "--plan one");
    CHECK(work.files("downwash-out/around_a_girder-mp-arm-ada-1-executed").count("solution.json") == 1);
    check_rejected(work.run("execute", girder, "--plan one --out one"), "holds the plan itself");
    check_rejected(work.run("execute", girder, "--plan one --margin 0.1"), "--margin is a setting of searches");
}

TEST_CASE("Targets in space are solved in any order, executed and validated in the order that was found") {
    const Workspace work;
    write_file(work.in_run("mission.yaml"), "schema: downwash/problem/v1\nname: mission\nrobot: " DOWNWASH_PROBLEMS
                                            "/robots/hexa960_arm2.yaml\n"
                                            "environment: {bounds: {x_m: [-4, 4], y_m: [-2, 2], z_m: [1, 5]}}\n"
                                            "aero: none\n"
                                            "start: {x_m: -3, y_m: 0, z_m: 2, joints_deg: [-90, 150]}\n"
                                            "goal:\n  in_any_order:\n"
                                            "    - {configuration: {x_m: 2, z_m: 3}, hold_s: 1}\n"
                                            "    - {configuration: {x_m: 0, z_m: 3}, hold_s: 1}\n"
                                            "  return_to: {x_m: -3, z_m: 2, hold_s: 1}\n"
                                            "  energy_budget_j: 100000\n"
                                            "planner: {variant: mp-arm-da, max_iterations: 200}\n");
    const Result solved = work.succeed("solve mission.yaml --out run");
    CHECK_THAT(solved.out, Contains("targets ") && Contains("2 of 2 targets met, and the return"));
    const Json order = Json::parse(work.text("run/solution.json")).at("order");
    REQUIRE(order.at("visits").size() == 2);
    CHECK(order.at("left_out").empty());
    const Result flown = work.succeed("execute mission.yaml --plan run --out flown");
    CHECK_THAT(flown.out, Contains("2 of 2 targets met, and the return"));
    CHECK(work.text("flown/trajectory.csv") == work.text("run/trajectory.csv"));
    CHECK(Json::parse(work.text("flown/solution.json")).at("order") == order);
    CHECK_THAT(work.succeed("validate mission.yaml --plan run").out, Catch::StartsWith("Valid. "));
    // In another order, the same hovers are not those of the goals.
    Json turned = Json::parse(work.text("run/solution.json"));
    std::swap(turned["order"]["visits"][0], turned["order"]["visits"][1]);
    turned.erase("files");
    write_file(work.in_run("turned.json"), turned.dump());
    CHECK(work.run("execute mission.yaml --plan turned.json --out turned").code == 3);
    CHECK_THAT(work.run("validate mission.yaml --plan turned.json").out, Catch::StartsWith("Not valid. "));
}

TEST_CASE("References in space whose flights fail end with 3") {
    const Workspace work;
    const auto outcome_of = [&work](const std::string& text) {
        write_file(work.in_run("plan.json"), text);
        const Result flown = work.run("execute", girder, "--plan plan.json --out flown --json");
        CHECK(flown.code == 3);
        const Result judged = work.run("validate", girder, "--plan plan.json --json --quiet");
        CHECK(judged.code == 3);
        CHECK(judged.json().at("outcome") == flown.json().at("execution").at("outcome"));
        CHECK(work.text("flown/trajectory.csv").size() > 1000);
        return flown.json().at("execution").at("outcome").get<std::string>();
    };
    CHECK(outcome_of(edited_reference(2, [](Json& knots) {  // down to the ground, which the arm meets first
              knots[1]["z_m"] = 0.25;
          })) == "collision");
    const std::string fast = edited_reference(2, [](Json& knots) {
        knots[1]["t_s"] = 0.5;
        knots[1]["y_m"] = -2.4;
        knots[1]["x_m"] = 3;
    });
    CHECK(outcome_of(fast) == "unstable");
    const Result warned = work.run("execute", girder, "--plan plan.json --out flown");
    CHECK_THAT(warned.err, Contains("plan.json:") && Contains("warning: plan.reference[1]: the way here") &&
                               Contains("max_speed_m_s"));
    CHECK_THAT(warned.out, Catch::StartsWith("The flight with direct aerodynamics becomes unstable."));
    CHECK_FALSE(Json::parse(work.text("flown/solution.json")).at("warnings").empty());
    CHECK_THAT(work.run("validate", girder, "--plan plan.json").out,
               Catch::StartsWith("Not valid. The flight becomes unstable, and the file is contradicted"));
}

TEST_CASE("References in space that cannot be flown are rejected with their place") {
    const Workspace work;
    const auto rejected = [&work](const std::string& text, const std::string& reason) {
        write_file(work.in_run("plan.json"), text);
        check_rejected(work.run("execute", girder, "--plan plan.json --out flown"), reason);
        check_rejected(work.run("validate", girder, "--plan plan.json"), reason);
    };
    rejected(edited_reference(2, [](Json& knots) { knots[1].erase("y_m"); }), "plan.reference[1]: 'y_m' is missing");
    rejected(edited_reference(2, [](Json& knots) { knots[1]["t_s"] = 5.503; }), "control ticks");
    rejected(plan_through_walkway, "this is a plan in a vertical plane");
    rejected("{", "plan.json:1:");
    rejected("", "the file is empty");
    check_rejected(work.run("execute", girder, "--plan nowhere.json"), "cannot be read");
    check_rejected(work.run("execute", girder, "--plan", reference, "--seed 3"), "expected --world too");
    check_rejected(work.run("validate", girder, "--plan", reference, "--runs 0"), "expected 1 to");
    CHECK(work.files().size() == 1);
    // A plan of a problem in the plane names its own kind.
    write_file(work.in_run("plan.json"), read_file(reference));
    check_rejected(work.run("execute", problem_file("open_air"), "--plan plan.json"), "this is a plan in space");
}

TEST_CASE("A plan in space is validated in worlds, the same on any number of threads") {
    const Workspace work;
    std::string problem = replaced(read_file(girder), "hold_s: 5", "hold_s: 1");
    problem = replaced(problem, "../robots/", DOWNWASH_PROBLEMS "/robots/");
    const std::size_t goal = problem.find("  end_effector:");
    problem.replace(goal, problem.find('\n', goal) - goal,
                    "  configuration: {x_m: 0, y_m: -1.2, z_m: 3.1, tolerance_m: 0.3}");
    write_file(work.in_run("short.yaml"), problem);
    write_file(work.in_run("short.json"), edited_reference(2, [](Json&) {}));
    const Words words_of_all = words("validate short.yaml --plan short.json --runs 4 --seed 2 --json --quiet");
    const Result one = work.succeed(words_of_all, "--threads 1 --out found");
    CHECK(one.err.empty());
    CHECK(work.succeed(words_of_all, "--threads 2").out == one.out);
    CHECK(work.succeed(words_of_all, "--threads 3").out == one.out);
    CHECK(work.text("found/validation.json") == one.out);
    const Json found = one.json();
    CHECK(found.at("runs") == 4);
    CHECK(found.at("failures") == 0);
    CHECK(found.at("failure_probability").at("estimate") == 0);
    CHECK(found.at("failure_probability").at("high").get<double>() == Approx(0.6024).margin(1e-3));
    CHECK(found.at("sensitivity").size() > 10);
    CHECK(found.at("worst").size() == 4);
    const Result text = work.succeed("validate short.yaml --plan short.json --runs 4 --seed 2 --quiet");
    CHECK_THAT(text.out, Contains("0 of 4 worlds: probability 0.0000") &&
                             Contains("downwash validate short.yaml --plan short.json --seed 2 --world "));
    const std::string worst = std::to_string(found.at("worst").at(0).at("world").get<int>());
    const Json single = work.json("validate short.yaml --plan short.json --seed 2 --quiet --world", worst);
    CHECK(single.at("min_clearance_m") == found.at("worst").at(0).at("min_clearance_m"));
}

TEST_CASE("Commands that cannot take a problem in space say what can be done with it, in one line") {
    const Workspace work;
    work.succeed("execute", girder, "--plan", reference, "--out run");
    const auto rejected = [&work](const Words& command, const std::string& reason) {
        const Result result = work.run(command);
        INFO(result.err);
        check_rejected(result, reason);
        CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    };
    const std::string in_space = "around_a_girder.yaml:11:26: environment.bounds.y_m makes this a problem in space";
    rejected(words("aeromap build", girder, "-o map.csv"), in_space);
    rejected(words("aeromap query", girder, "--at 0 0 1"), in_space);
}

TEST_CASE("A run in space is exported in every format and drawn") {
    const Workspace work;
    work.succeed("execute", girder, "--plan", reference, "--out run");
    for (const auto& [format, name] : {std::pair{"csv", "setpoints.csv"},
                                       {"ros", "trajectory.json"},
                                       {"px4 --bearing 90", "px4.json"},
                                       {"px4-csv --bearing 90", "px4.csv"},
                                       {"mavlink --bearing 90", "setpoints.tlog"},
                                       {"ros --bearing 90 -o run/map.json", "map.json"},
                                       {"qgc --origin 47 -8.5 400 --bearing 90", "mission.plan"},
                                       {"vtp", "flight.vtp"},
                                       {"vtp-scene", "scene.vtp"},
                                       {"glb", "run.glb"}}) {
        CAPTURE(format);
        CHECK(work.succeed("export run --format", format).out == std::string("run/") + name + "\n");
        CHECK(work.text(std::string("run/") + name).size() > 200);
    }
    CHECK_THAT(work.text("run/setpoints.csv"), Catch::StartsWith("t_s,x_m,y_m,z_m,") && Contains(",joint_3_rad,"));
    check_rejected(work.run("export run --format csv --bearing 90"), "--bearing: the format csv stays in the frame");
    for (const char* file : {"setpoints.csv", "trajectory.json"}) {
        work.succeed("export run --check", std::string("run/") + file);
    }
    for (const char* file : {"px4.json", "px4.csv", "setpoints.tlog", "map.json"}) {
        work.succeed("export run --bearing 90 --check", std::string("run/") + file);
    }
    CHECK(work.succeed("report run --svg --no-labels -o figures").out == "figures/flight.svg\nfigures/plots.svg\n");
    CHECK_THAT(work.text("figures/flight.svg"), Contains("from the front") && !Contains("bottom_flange"));
    // The page of the run, with what the judge found.
    work.succeed("validate", girder, "--plan run --quiet --out judged");
    const auto judged = work.files("judged");
    CHECK(Json::parse(judged.at("validation.json")).at("outcome") == "ok");
    CHECK(judged.count("validation.html") == work.files("run").count("report.html"));
    // A flight that failed is not handed on unasked.
    write_file(work.in_run("low.json"), edited_reference(2, [](Json& knots) { knots[1]["z_m"] = 0.25; }));
    CHECK(work.run("execute", girder, "--plan low.json --out low").code == 3);
    check_rejected(work.run("export low --format ros"), "its flight ended 'collision'; --anyway");
    work.succeed("export low --format ros --anyway");
}

TEST_CASE("A campaign runs problems in space and reports them, and says where it cannot") {
    const Workspace work;
    const std::string head = "schema: downwash/campaign/v1\nname: small\nvariants: [mp-arm-da]\nseeds: {count: 2}\n";
    write_file(work.in_run("campaign.yaml"),
               head + "max_iterations: 60\nas_believed: true\nevaluation_worlds: 2\nproblems: [" + girder + "]\n");
    CHECK_THAT(work.succeed("bench run campaign.yaml --out campaign --quiet").out, Contains("2 of 2 runs"));
    const Json report = work.json("bench report campaign");
    CHECK_THAT(report.dump(), Contains("around_a_girder"));
    CHECK_THAT(work.succeed("bench report campaign").out, Contains("around_a_girder"));
    std::string text = read_file(girder);
    text.replace(text.find("../robots/"), 10, DOWNWASH_PROBLEMS "/robots/");
    write_file(work.in_run("narrow.yaml"), text + "planner: {parameters: {passage_share: 0.2}}\n");
    write_file(work.in_run("campaign.yaml"), head + "problems: [narrow.yaml]\n");
    check_rejected(work.run("bench run campaign.yaml --out other"), "narrow.yaml:25:");
}

TEST_CASE("The flights of docs/space_files.md go well and print what it quotes") {
    const Workspace work;
    std::filesystem::create_directory_symlink(DOWNWASH_PROBLEMS, work.in_run("problems"));
    std::istringstream page(read_file(DOWNWASH_SPACE_PAGE));
    const std::string prompt = "$ downwash ";
    std::istringstream printed;
    std::size_t commands = 0;
    bool is_session = false;
    for (std::string line; std::getline(page, line);) {
        if (line == "```") {
            is_session = false;
        } else if (line.starts_with(prompt)) {
            is_session = true;
            ++commands;
            printed = std::istringstream(work.succeed(line.substr(prompt.size()).c_str()).out);
        } else if (is_session && !line.empty() && line != "...") {
            INFO(line);
            std::string each;
            while (std::getline(printed, each) && each != line) {
            }
            CHECK(each == line);
        }
    }
    CHECK(commands == 3);
}
