#include <fmt/core.h>

#include <filesystem>

#include "downwash/base/embedded_file.hpp"
#include "downwash/cli/commands.hpp"
#include "downwash/cli/output_folder.hpp"
#include "downwash/cli/usage_error.hpp"

DOWNWASH_EMBED_FILE(downwash_first_problem, DOWNWASH_FIRST_PROBLEM);
DOWNWASH_EMBED_FILE(downwash_first_robot, DOWNWASH_FIRST_ROBOT);

namespace downwash::cli {
namespace {

namespace fs = std::filesystem;

struct InitArguments {
    std::string file = "my_problem.yaml";
};

/// Never replaces what somebody wrote.
void write_new(const fs::path& file, std::string_view content) {
    if (fs::exists(fs::symlink_status(file))) {
        throw UsageError(file.string() + " is there already; choose another name");
    }
    write_result(file, content);
}

ExitCode run(const InitArguments& arguments) {
    const fs::path problem(arguments.file);
    const fs::path robot = problem.parent_path() / "ars_lrm.yaml";
    write_new(problem, DOWNWASH_EMBEDDED_FILE(downwash_first_problem));
    if (!fs::exists(robot)) {
        write_new(robot, DOWNWASH_EMBEDDED_FILE(downwash_first_robot));
    }
    fmt::print("{}\n{}\n", problem.string(), robot.string());
    return ExitCode::done;
}

}  // namespace

void add_init(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<InitArguments>();
    CLI::App* command = program.add_subcommand(
        "init", "Write a problem with comments to start from, and its robot beside it; replaces no file");
    command->add_option("FILE", arguments->file, "the problem; default my_problem.yaml");
    command->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace downwash::cli
