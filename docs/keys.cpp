// Prints docs/keys.md: every key of problem, robot and campaign files, from the tables that also read them.

#include <fmt/core.h>

#include <set>
#include <string>

#include "downwash/problems/key_reference.hpp"

using namespace downwash;

namespace {

std::string line_of(const KeyReference& key) {
    const std::string condition = key.info.condition.empty() ? "" : " (" + key.info.condition + ")";
    const std::string former = key.info.former_name.empty() ? "" : fmt::format("; formerly `{}`", key.info.former_name);
    return fmt::format("| `{}` | {} | {} | {}{}{} |\n", key.info.path, expectation(key.info), key.default_text,
                       key.info.description, former, condition);
}

/// @param known lines that are not printed again
void print_table(FileKind kind, const std::set<std::string>& known = {}) {
    fmt::print("| key | expected | default | meaning |\n| --- | --- | --- | --- |\n");
    for (const KeyReference& key : key_reference(kind)) {
        if (const std::string line = line_of(key); !known.contains(line)) {
            fmt::print("{}", line);
        }
    }
}

std::set<std::string> lines_of(FileKind kind) {
    std::set<std::string> lines;
    for (const KeyReference& key : key_reference(kind)) {
        lines.insert(line_of(key));
    }
    return lines;
}

}  // namespace

int main() {
    fmt::print(
        "# Keys of problem, robot and campaign files\n\n"
        "This page lists every key that you can write in a file, with its range and default. `downwash explain KEY` "
        "prints the same for\none key. `downwash check --schema problem` (or robot, campaign, space-problem, "
        "space-robot) prints a JSON Schema, "
        "with which editors complete and check files.\n\n"
        "Angles in files are in degrees. `[]` stands for the elements of a list. A robot may be inline or in its own "
        "file with\n`schema: downwash/robot/v1`. `cmake --build build --target docs` prints this page from the tables "
        "that read the files.\n\n");
    print_table(FileKind::problem);
    fmt::print(
        "\n## Problems and robots in space\n\nA problem is in space when its bounds have `y_m` ([space_files.md]"
        "(space_files.md)). It has these keys, and those above that are not listed here and mean the same: obstacles, "
        "`aero`\nwithout a map, `uncertainty` and `planner`. `downwash explain KEY --of space-problem` explains "
        "one.\n\n");
    print_table(FileKind::space_problem, lines_of(FileKind::problem));
    fmt::print(
        "\n## Campaigns\n\n`downwash bench run` reads these keys ([benchmarking.md](benchmarking.md)). Limits replace "
        "those of the problem files.\n\n");
    print_table(FileKind::campaign);
}
