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

std::vector<LocatedFault> faults_of(const std::string& path) {
    try {
        static_cast<void>(read_problem(path));
    } catch (const ProblemFileError& error) {
        return error.faults();
    }
    return {};
}

void print_json(const std::vector<LocatedFault>& faults) {
    auto list = nlohmann::ordered_json::array();
    for (const LocatedFault& fault : faults) {
        list.push_back(
            {{"file", fault.file}, {"line", fault.line}, {"column", fault.column}, {"message", fault.message}});
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
    std::vector<LocatedFault> all;
    for (const std::string& path : arguments.problems) {
        const std::vector<LocatedFault> faults = faults_of(path);
        for (const LocatedFault& fault : faults) {
            print_error(fmt::format("{}\n", to_text(fault)));
        }
        if (faults.empty() && !arguments.as_json) {
            fmt::print("{}: ok\n", path);
        }
        all.insert(all.end(), faults.begin(), faults.end());
    }
    if (arguments.as_json) {
        print_json(all);
    }
    return all.empty() ? ExitCode::done : ExitCode::bad_input;
}

}  // namespace

void add_check(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<CheckArguments>();
    CLI::App* command = program.add_subcommand("check", "Say whether problem files are sound, and every fault if not");
    command->add_option("PROBLEM", arguments->problems, "problem files");
    CLI::Option* schema = command->add_option(
        "--schema", arguments->schema,
        "print the JSON Schema of a kind of file instead, for editors that complete and check YAML");
    require_one_of(*schema, std::array<std::string_view, 3>{"problem", "robot", "campaign"});
    command->add_flag("--json", arguments->as_json, "print the faults as JSON on standard output");
    command->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace downwash::cli
