// Prints docs/keys.md: every key of problem, robot and campaign files, from the tables that also read them.

#include <fmt/core.h>

#include "downwash/problems/key_reference.hpp"

using namespace downwash;

namespace {

void print_table(FileKind kind) {
    fmt::print("| key | expected | default | meaning |\n| --- | --- | --- | --- |\n");
    for (const KeyReference& key : key_reference(kind)) {
        const std::string condition = key.info.condition.empty() ? "" : " (" + key.info.condition + ")";
        const std::string former =
            key.info.former_name.empty() ? "" : fmt::format("; formerly `{}`", key.info.former_name);
        fmt::print("| `{}` | {} | {} | {}{}{} |\n", key.info.path, expectation(key.info), key.default_text,
                   key.info.description, former, condition);
    }
}

}  // namespace

int main() {
    fmt::print(
        "# Keys of problem, robot and campaign files\n\n"
        "This page lists every key that you can write in a file, with its range and default. `downwash explain KEY` "
        "prints the same for\none key. `downwash check --schema problem` (or robot, campaign) prints a JSON Schema, "
        "with which editors complete and check files.\n\n"
        "Angles in files are in degrees. `[]` stands for the elements of a list. A robot may be inline or in its own "
        "file with\n`schema: downwash/robot/v1`. `cmake --build build --target docs` prints this page from the tables "
        "that read the files.\n\n");
    print_table(FileKind::problem);
    fmt::print(
        "\n## Campaigns\n\n`downwash bench run` reads these keys ([benchmarking.md](benchmarking.md)). Limits replace "
        "those of the problem files.\n\n");
    print_table(FileKind::campaign);
}
