#include <fmt/core.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/cli/common_options.hpp"
#include "downwash/cli/completion.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/key_reference.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash::cli {
namespace {

struct CheckArguments {
    std::vector<std::string> problems;
    std::optional<std::string> schema;
    bool as_json = false;

    void add_to(CLI::App& command);
    [[nodiscard]] ExitCode run() const;
};

std::vector<LocatedError> errors_of(const std::string& path) {
    try {
        static_cast<void>(read_problem(path));
    } catch (const ProblemFileError& error) {
        return error.errors();
    }
    return {};
}

ExitCode CheckArguments::run() const {
    if (schema) {
        fmt::print("{}", json_schema(*file_kind_named(*schema)));
        return ExitCode::done;
    }
    if (problems.empty()) {
        throw UsageError("which files? Expected problem files, or --schema problem, robot or campaign");
    }
    auto list = nlohmann::ordered_json::array();
    for (const std::string& path : problems) {
        const std::vector<LocatedError> errors = errors_of(path);
        for (const LocatedError& error : errors) {
            print_error(fmt::format("{}\n", to_text(error)));
            list.push_back(
                {{"file", error.file}, {"line", error.line}, {"column", error.column}, {"message", error.message}});
        }
        if (errors.empty() && !as_json) {
            fmt::print("{}: ok\n", path);
        }
    }
    const ExitCode code = list.empty() ? ExitCode::done : ExitCode::bad_input;
    if (as_json) {
        print_json({{"faults", std::move(list)}});
    }
    return code;
}

void CheckArguments::add_to(CLI::App& command) {
    command.add_option("PROBLEM", problems, "problem files");
    CLI::Option* option =
        command.add_option("--schema", schema,
                           "print the JSON Schema of a kind of file instead, for editors that complete and check YAML");
    require_one_of(*option, std::array<std::string_view, 3>{"problem", "robot", "campaign"});
    add_json(command, as_json, "print the errors as JSON on standard output");
}

}  // namespace

void add_check(CLI::App& program, Action& action) {
    add_command<CheckArguments>(program, action, "check",
                                "Check problem files and report every error with its line and column");
}

}  // namespace downwash::cli
