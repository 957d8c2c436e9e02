#include <fmt/core.h>

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/cli/commands.hpp"
#include "downwash/cli/completion.hpp"
#include "downwash/cli/json_text.hpp"
#include "downwash/cli/standard_error.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/key_reference.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash::cli {
namespace {

struct CheckArguments {
    std::vector<std::string> problems;
    std::optional<std::string> schema;
    bool as_json = false;
};

std::vector<LocatedError> errors_of(const std::string& path) {
    try {
        static_cast<void>(read_problem(path));
    } catch (const ProblemFileError& error) {
        return error.errors();
    }
    return {};
}

void print_json(const std::vector<LocatedError>& errors) {
    auto list = nlohmann::ordered_json::array();
    for (const LocatedError& error : errors) {
        list.push_back(
            {{"file", error.file}, {"line", error.line}, {"column", error.column}, {"message", error.message}});
    }
    const nlohmann::ordered_json document{{"faults", std::move(list)}};
    fmt::print("{}\n", json_text(document));
}

ExitCode run(const CheckArguments& arguments) {
    if (arguments.schema) {
        fmt::print("{}", json_schema(*file_kind_named(*arguments.schema)));
        return ExitCode::done;
    }
    if (arguments.problems.empty()) {
        throw UsageError("which files? Expected problem files, or --schema problem, robot or campaign");
    }
    std::vector<LocatedError> all;
    for (const std::string& path : arguments.problems) {
        const std::vector<LocatedError> errors = errors_of(path);
        for (const LocatedError& error : errors) {
            print_error(fmt::format("{}\n", to_text(error)));
        }
        if (errors.empty() && !arguments.as_json) {
            fmt::print("{}: ok\n", path);
        }
        all.insert(all.end(), errors.begin(), errors.end());
    }
    if (arguments.as_json) {
        print_json(all);
    }
    return all.empty() ? ExitCode::done : ExitCode::bad_input;
}

}  // namespace

void add_check(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<CheckArguments>();
    CLI::App* command = program.add_subcommand("check", "Say whether problem files are sound, and every error if not");
    command->add_option("PROBLEM", arguments->problems, "problem files");
    CLI::Option* schema = command->add_option(
        "--schema", arguments->schema,
        "print the JSON Schema of a kind of file instead, for editors that complete and check YAML");
    require_one_of(*schema, std::array<std::string_view, 3>{"problem", "robot", "campaign"});
    command->add_flag("--json", arguments->as_json, "print the errors as JSON on standard output");
    command->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace downwash::cli
