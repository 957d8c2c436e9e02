// Prints docs/keys.md: every key of problem and robot files, from the one table that also reads them.

#include <fmt/core.h>

#include <string>

#include "downwash/planner/problem_parameters.hpp"

using namespace downwash;

namespace {

std::string default_text(const Parameter<Problem>& parameter) {
    if (parameter.required) {
        return "required";
    }
    if (parameter.exclusive) {
        return "one of its group";
    }
    // Keys of lists and of things that may be absent have no value in an empty problem.
    if (!parameter.get || parameter.path.find("[]") != std::string::npos || parameter.path.rfind("goal.", 0) == 0) {
        return "";
    }
    static const Problem defaults;
    const Value value = parameter.get(defaults, 0);
    if (const auto* flag = std::get_if<bool>(&value)) {
        return *flag ? "true" : "false";
    }
    if (const auto* number = std::get_if<double>(&value)) {
        return fmt::format("{:.6g}", is_in_degrees(parameter.path) ? *number * 57.29577951308232 : *number);
    }
    if (const auto* integer = std::get_if<std::uint64_t>(&value)) {
        return fmt::format("{}", *integer);
    }
    if (const auto* text = std::get_if<std::string>(&value)) {
        return *text;
    }
    return std::holds_alternative<std::monostate>(value) ? "null" : "";
}

}  // namespace

int main() {
    fmt::print(
        "# Keys of problem and robot files\n\n"
        "Printed from the table that reads them (`cmake --build build --target docs`). Angles are degrees in files. "
        "`[]` stands for\nthe elements of a list. A robot may stand inline or in a file of its own with "
        "`schema: downwash/robot/v1`.\n\n"
        "| key | expected | default | meaning |\n| --- | --- | --- | --- |\n");
    for (const Parameter<Problem>& parameter : problem_parameters().rows()) {
        std::string meaning = parameter.description;
        if (!parameter.condition.empty()) {
            meaning += " (" + parameter.condition + ")";
        }
        fmt::print("| `{}` | {} | {} | {} |\n", parameter.path, expectation(parameter), default_text(parameter),
                   meaning);
    }
}
