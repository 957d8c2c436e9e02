#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/input_lines.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/run_report.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/planner/space_solve.hpp"
#include "downwash/problems/campaign_reader.hpp"
#include "downwash/problems/input_facts.hpp"
#include "downwash/problems/key_reference.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/problems/space_problem_writer.hpp"
#include "downwash/report/problem_figure.hpp"
#include "downwash/report/problem_page.hpp"
#include "downwash/report/space_page.hpp"
#include "downwash/report/space_problem_figure.hpp"
#include "downwash/results/input_document.hpp"
#include "downwash/scene/scene.hpp"

namespace downwash::cli {
namespace {

namespace fs = std::filesystem;

struct CheckArguments {
    std::vector<std::string> problems;
    std::optional<std::string> schema, picture, page;
    bool as_json = false;

    [[nodiscard]] bool draws() const { return picture || page; }
};

/// What a file is: "data" by its ending; "robot" or "campaign" by the first words of its `schema:` line; else
/// "problem".
std::string kind_of(const std::string& path) {
    const std::string ending = fs::path(path).extension().string();
    if (is_same_word(ending, ".csv") || is_same_word(ending, ".tsv")) {
        return "data";
    }
    std::ifstream file(path);
    std::string line;
    for (int i = 0; i < 200 && std::getline(file, line); ++i) {
        for (const char* kind : {"robot", "campaign"}) {
            if (line.starts_with("schema:") && line.find(fmt::format("downwash/{}/", kind)) != std::string::npos) {
                return kind;
            }
        }
    }
    return "problem";
}

/// Where a problem names files of its scene; nothing for the endings of other files.
std::string key_of_scene_file(const std::string& path) {
    const std::string ending = fs::path(path).extension().string();
    const auto is_one_of = [&ending](std::initializer_list<const char*> endings) {
        return std::any_of(endings.begin(), endings.end(),
                           [&ending](const char* each) { return is_same_word(ending, each); });
    };
    return is_one_of({".stl", ".obj"}) ? "environment.obstacles[].mesh.file"
           : is_one_of({".bt", ".ot"}) ? "environment.obstacles[].octomap.file"
                                       : "";
}

struct Findings {
    std::vector<LocatedError> errors;
    std::vector<LocatedError> warnings;  ///< keys by their former names included
    // What was read, one of them unless the file is a campaign; with errors a problem only:
    std::optional<ProblemReading> problem;
    std::optional<Robot> robot;
    std::optional<SpaceProblem> space_problem;
    std::optional<SpaceRobot> space_robot;
    std::optional<DataFacts> data;
};

/// Takes a number and a colon off the beginning of a text; nothing if there is none.
std::optional<int> taken_number(std::string_view& text) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end == text.data() + text.size() || *end != ':') {
        return std::nullopt;
    }
    text.remove_prefix(static_cast<std::size_t>(end - text.data()) + 1);
    return number;
}

/// An error of a file of numbers, "file:line:column: what is wrong", with its place.
LocatedError located(const std::string& path, const std::string& message) {
    std::string_view text = message;
    if (text.starts_with(path)) {
        text.remove_prefix(path.size());
    }
    LocatedError error{path, 1, 1, ""};
    if (text.starts_with(":")) {
        text.remove_prefix(1);
        error.line = taken_number(text).value_or(1);
        error.column = taken_number(text).value_or(1);
    }
    error.message = trimmed(text);
    return error;
}

Findings findings_in(const std::string& path) {
    Findings found;
    const auto on_warning = [&found](const LocatedError& warning) { found.warnings.push_back(warning); };
    if (const std::string key = key_of_scene_file(path); !key.empty()) {
        found.errors.push_back({path, 1, 1,
                                "is part of a scene: expected a problem that names it in " + key +
                                    ", a robot, a campaign, or numbers in a file that ends in .csv or .tsv"});
        return found;
    }
    try {
        const std::string kind = kind_of(path);
        if (kind == "robot" && is_space_robot_file(path)) {
            found.space_robot = read_space_robot(path, on_warning);
        } else if (kind == "problem" && is_space_problem_file(path)) {
            found.space_problem = read_space_problem(path, {}, on_warning, space_planning_errors);
        } else if (kind == "robot") {
            found.robot = read_robot(path, on_warning);
        } else if (kind == "campaign") {
            static_cast<void>(read_campaign(path, on_warning, on_warning, space_planning_errors));
        } else if (kind == "data") {
            found.data = read_data_file(path);
            for (const std::string& remark : data_remarks(*found.data)) {
                found.warnings.push_back({path, 1, 1, remark});
            }
        } else {
            found.problem = examine_problem(path);
            found.errors = found.problem->errors;
            found.warnings = found.problem->warnings;
        }
    } catch (const ProblemFileError& error) {
        found.errors = error.errors();
    } catch (const InputError& error) {
        if (kind_of(path) != "data") {
            throw;
        }
        for (const KeyError& each : error.errors()) {
            found.errors.push_back(located(path, each.message));
        }
    }
    return found;
}

Json json_of_finding(const LocatedError& found) {
    return {{"file", found.file}, {"line", found.line}, {"column", found.column}, {"message", found.message}};
}

/// The lists of what was read, of all files.
struct ReadLists {
    Json geometry = Json::array(), robots = Json::array(), data = Json::array();
};

/// Adds what a file became to the lists. @return the same as lines for people
std::string add_inputs(const std::string& path, const Findings& found, ReadLists& lists) {
    std::string text;
    const auto add = [&text](Json& list, Json origin, const std::string& facts, const std::string& line) {
        origin.update(Json::parse(facts));
        list.push_back(std::move(origin));
        text += "  " + line + "\n";
    };
    if (found.robot) {
        const RobotInput robot{found.robot->name, robot_facts(*found.robot)};
        add(lists.robots, {{"problem", nullptr}, {"file", path}}, robot_document(robot), text_of(robot));
    }
    if (found.space_robot) {
        const SpaceRobotInput robot{found.space_robot->name, space_robot_facts(*found.space_robot)};
        add(lists.robots, {{"problem", nullptr}, {"file", path}}, robot_document(robot), text_of(robot));
    }
    if (found.space_problem) {
        const SpaceRobotInput robot{found.space_problem->robot.name, space_robot_facts(found.space_problem->robot)};
        add(lists.robots, {{"problem", path}, {"file", nullptr}}, robot_document(robot), text_of(robot));
        for (const GeometryInput& each : geometry_inputs(Scene(found.space_problem->obstacles))) {
            add(lists.geometry, {{"problem", path}}, geometry_document(each), text_of(each));
        }
        for (const DataFacts& each : data_facts(found.space_problem->aero)) {
            add(lists.data, {{"problem", path}}, data_document(each), text_of(each));
        }
    }
    if (found.data) {
        add(lists.data, {{"problem", nullptr}}, data_document(*found.data), text_of(*found.data));
    }
    if (found.problem) {
        const ProblemReading& read = *found.problem;
        if (!read.wrong.touch("robot")) {
            const RobotInput robot{read.problem.robot.name, robot_facts(read.problem.robot)};
            add(lists.robots, {{"problem", path}, {"file", nullptr}}, robot_document(robot), text_of(robot));
        }
        if (read.scene != nullptr) {
            for (const GeometryInput& each : geometry_inputs(*read.scene)) {
                add(lists.geometry, {{"problem", path}}, geometry_document(each), text_of(each));
            }
        }
        for (const DataFacts& each : read.wrong.touch("aero") ? std::vector<DataFacts>() : data_facts(read.problem)) {
            add(lists.data, {{"problem", path}}, data_document(each), text_of(each));
        }
    }
    return text;
}

/// Checks what can be checked of --picture and --page before anything is read.
void require_drawable_request(const CheckArguments& given) {
    if (!given.draws()) {
        return;
    }
    const char* option = given.picture ? "--picture" : "--page";
    if (given.schema || given.problems.size() != 1) {
        throw UsageError("{} shows one problem: expected one problem file with it", option);
    }
    if (const std::string kind = kind_of(given.problems.front()); kind != "problem") {
        throw UsageError("{} shows a problem, and {} is a {} file: expected the file of a problem", option,
                         given.problems.front(), kind);
    }
    if (given.picture) {
        static_cast<void>(picture_format("--picture", *given.picture));
        require_writable_result(*given.picture, "--picture");
    }
    if (given.page) {
        if (!is_same_word(fs::path(*given.page).extension().string(), ".html")) {
            throw UsageError("--page '{}': expected a name that ends in .html", excerpt(*given.page));
        }
        require_pages();
        require_writable_result(*given.page, "--page");
    }
}

/// What is drawn of a problem before it is planned.
struct ProblemDrawings {
    std::string picture, page;  ///< empty: not asked for, or not possible
};

ProblemDrawings drawings_of(const CheckArguments& given, const Findings& found, const PictureSettings& settings) {
    const ProblemReading& read = *found.problem;
    const Problem& problem = read.problem;
    ProblemDrawings made;
    if (given.picture) {
        made.picture = draw(problem_figure(problem, *read.model), settings);
    }
    if (given.page && read.errors.empty()) {
        const fs::path folder = fs::absolute(*given.page).parent_path();
        const ProblemReference reference{
            problem.name,   given.problems.front(), problem_sha256(problem),
            found.warnings, problem.axes(),         input_facts(problem, read.model->scene())};
        made.page = problem_page(problem, reference, effective_yaml(problem, folder), *read.model, settings.threads);
    }
    return made;
}

/// The same in space.
ProblemDrawings space_drawings_of(const CheckArguments& given, const Findings& found, const PictureSettings& settings) {
    const SpaceProblem& problem = *found.space_problem;
    ProblemDrawings made;
    if (given.picture) {
        made.picture = draw(space_problem_figure(problem, Scene(problem.obstacles)), settings);
    }
    if (given.page) {
        Json warnings = Json::array();
        for (const LocatedError& warning : found.warnings) {
            warnings.push_back(json_of_finding(warning));
        }
        SpaceRun run;
        run.problem_text = effective_yaml(problem, fs::absolute(*given.page).parent_path());
        run.warnings = warnings.dump();
        made.page = space_page(problem, run);
    }
    return made;
}

/// Draws the problem before it is planned; one in a plane that has errors as a picture only. Both files are made before
/// one is written.
void draw_problem(const CheckArguments& given, const Findings& found) {
    PictureSettings settings;
    settings.threads = default_threads();
    if (given.picture) {
        settings.format = picture_format("--picture", *given.picture);
    }
    const ProblemDrawings made =
        found.space_problem ? space_drawings_of(given, found, settings) : drawings_of(given, found, settings);
    const auto write = [&given](const std::optional<std::string>& file, const std::string& content,
                                const char* option) {
        if (file && !content.empty()) {
            write_result(*file, content, option);
            if (!given.as_json) {
                fmt::print("{}\n", *file);
            }
        }
    };
    write(given.picture, made.picture, "--picture");
    write(given.page, made.page, "--page");
}

ExitCode run(const CheckArguments& given) {
    require_drawable_request(given);
    if (given.schema) {
        fmt::print("{}", json_schema(*file_kind_named(*given.schema)));
        return ExitCode::done;
    }
    if (given.problems.empty()) {
        throw UsageError("expected problem files, or --schema problem, robot, campaign, space-problem or space-robot");
    }
    auto faults = Json::array();
    auto warnings = Json::array();
    ReadLists lists;
    std::set<std::string> told;  // two problems may have the same robot
    for (const std::string& path : given.problems) {
        const Findings found = findings_in(path);
        for (const LocatedError& error : found.errors) {
            if (told.insert(to_text(error)).second) {
                print_error(fmt::format("{}\n", to_text(error)));
                faults.push_back(json_of_finding(error));
            }
        }
        for (const LocatedError& warning : found.warnings) {
            if (told.insert(to_text(warning)).second) {
                print_warning(warning);
                warnings.push_back(json_of_finding(warning));
            }
        }
        const std::string lines = add_inputs(path, found, lists);
        if (!given.as_json && (found.errors.empty() || !lines.empty())) {
            const auto counted = [](std::size_t count, const char* thing) {
                return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
            };
            fmt::print("{}: {}{}\n{}", path, found.errors.empty() ? "ok" : counted(found.errors.size(), "error"),
                       found.warnings.empty() ? "" : ", " + counted(found.warnings.size(), "warning"), lines);
        }
        if (given.draws() && (found.space_problem || (found.problem && found.problem->model != nullptr))) {
            draw_problem(given, found);
        }
    }
    const ExitCode code = faults.empty() ? ExitCode::done : ExitCode::bad_input;
    if (given.as_json) {
        print_json({{"faults", std::move(faults)},
                    {"warnings", std::move(warnings)},
                    {"geometry", std::move(lists.geometry)},
                    {"robots", std::move(lists.robots)},
                    {"data", std::move(lists.data)}});
    }
    return code;
}

}  // namespace

void add_check(Command program, Action& action) {
    auto [command, given] = add_command<CheckArguments>(
        program, action, "check",
        "Check problem, robot and campaign files and files of numbers (CSV); report every error and warning with its "
        "line and column, and on one line each what robots, meshes, octrees and tables became; with --picture or "
        "--page, show a problem before it is planned",
        run);
    command
        .add_option("PROBLEM", given.problems,
                    "problem, robot or campaign files, or grids, effect tables and measurements as .csv or .tsv")
        .offers_files({".yaml", ".yml", ".csv", ".tsv"});
    Option schema =
        command.add_option("--schema", given.schema,
                           "print the JSON Schema of a kind of file instead, for editors that complete and check YAML");
    schema.one_of({file_kind_names.begin(), file_kind_names.end()});
    command.add_option("--picture FILE", given.picture,
                       "draw the problem in the plane of motion, or in space in three views: scene, bounds, goals, and "
                       "the robot at its start; a picture, .svg, .png or .pdf");
    command.add_option("--page FILE", given.page,
                       "write the same as a page, .html, with the scene in three dimensions and, if it has one, in the "
                       "plane of motion");
    add_json(command, given.as_json, "the errors and warnings, and what robots, meshes, octrees and tables became");
}

}  // namespace downwash::cli
