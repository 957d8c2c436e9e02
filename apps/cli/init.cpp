#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "downwash/base/embedded_file.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/usage_error.hpp"

DOWNWASH_EMBED_FILE(downwash_first_problem, DOWNWASH_FIRST_PROBLEM);
DOWNWASH_EMBED_FILE(downwash_first_robot, DOWNWASH_FIRST_ROBOT);
DOWNWASH_EMBED_FILE(downwash_first_space_problem, DOWNWASH_FIRST_SPACE_PROBLEM);
DOWNWASH_EMBED_FILE(downwash_first_space_robot, DOWNWASH_FIRST_SPACE_ROBOT);

namespace downwash::cli {
namespace {

namespace fs = std::filesystem;

struct InitArguments {
    std::string file = "my_problem.yaml";
    bool in_space = false;
};

/// The text with every occurrence of a word replaced.
std::string replaced(std::string text, std::string_view word, std::string_view by) {
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + by.size())) {
        text.replace(at, word.size(), by);
    }
    return text;
}

/// A problem to start from for a file of that name. The problem gets the name of the file if that is a valid name.
std::string first_problem_for(const fs::path& file, std::string_view first_problem) {
    const auto in_place_of = [](std::string_view field, const std::string& word) {
        return fmt::format("{:<{}}", word, field.size());
    };
    constexpr std::string_view file_field = "my_problem.yaml      ";  // up to a blank before what the command does
    std::string text =
        replaced(std::string(first_problem), file_field, in_place_of(file_field, file.filename().string()));
    const std::string name = file.stem().string();
    const auto is_sound = [](char c) {
        return (std::isalnum(static_cast<unsigned char>(c)) != 0) || c == '_' || c == '-';
    };
    constexpr std::size_t longest = 64;
    if (name.size() <= longest && std::all_of(name.begin(), name.end(), is_sound)) {
        constexpr std::string_view field = "my_problem                        ";  // up to its comment
        text = replaced(std::move(text), field, in_place_of(field, name));
    }
    return text;
}

/// Writes a new file; never replaces one. @throws UsageError
void write_new(const fs::path& file, std::string_view content) {
    if (fs::exists(fs::symlink_status(file))) {
        throw UsageError(file.string() + " exists already; choose another name");
    }
    write_result(file, content);
}

ExitCode run(const InitArguments& given) {
    const fs::path problem(given.file);
    const fs::path robot = problem.parent_path() / (given.in_space ? "hexa370_arm3.yaml" : "ars_lrm.yaml");
    const std::string_view first_problem = given.in_space ? DOWNWASH_EMBEDDED_FILE(downwash_first_space_problem)
                                                          : DOWNWASH_EMBEDDED_FILE(downwash_first_problem);
    write_new(problem, first_problem_for(problem, first_problem));
    if (!fs::exists(robot)) {
        write_new(robot, given.in_space ? DOWNWASH_EMBEDDED_FILE(downwash_first_space_robot)
                                        : DOWNWASH_EMBEDDED_FILE(downwash_first_robot));
    }
    fmt::print("{}\n{}\n", problem.string(), robot.string());
    return ExitCode::done;
}

}  // namespace

void add_init(Command program, Action& action) {
    auto [command, given] = add_command<InitArguments>(
        program, action, "init",
        "Write a commented problem to start from, with its robot beside it; existing files are never replaced", run);
    command.add_option("FILE", given.file, "name of the problem file; default my_problem.yaml");
    command.add_flag("--space", given.in_space, "a problem in space, not in a vertical plane");
}

}  // namespace downwash::cli
