#include <fmt/core.h>

#include <optional>
#include <string>
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
};

std::vector<LocatedError> errors_of(const std::string& path) {
    try {
        static_cast<void>(read_problem(path, {}, print_outdated));
    } catch (const ProblemFileError& error) {
        return error.errors();
    }
    return {};
}

ExitCode run(const CheckArguments& given) {
    if (given.schema) {
        fmt::print("{}", json_schema(*file_kind_named(*given.schema)));
        return ExitCode::done;
    }
    if (given.problems.empty()) {
        throw UsageError("expected problem files, or --schema problem, robot or campaign");
    }
    auto list = Json::array();
    for (const std::string& path : given.problems) {
        const std::vector<LocatedError> errors = errors_of(path);
        for (const LocatedError& error : errors) {
            print_error(fmt::format("{}\n", to_text(error)));
            list.push_back(
                {{"file", error.file}, {"line", error.line}, {"column", error.column}, {"message", error.message}});
        }
        if (errors.empty() && !given.as_json) {
            fmt::print("{}: ok\n", path);
        }
    }
    const ExitCode code = list.empty() ? ExitCode::done : ExitCode::bad_input;
    if (given.as_json) {
        print_json({{"faults", std::move(list)}});
    }
    return code;
}

}  // namespace

void add_check(CLI::App& program, Action& action) {
    auto [command, given] = add_command(program, action, "check",
                                        "Check problem files and report every error with its line and column", run);
    command.add_option("PROBLEM", given.problems, "problem files");
    CLI::Option* schema =
        command.add_option("--schema", given.schema,
                           "print the JSON Schema of a kind of file instead, for editors that complete and check YAML");
    require_one_of(*schema, {"problem", "robot", "campaign"});
    add_json(command, given.as_json, "the errors");
}

}  // namespace downwash::cli
