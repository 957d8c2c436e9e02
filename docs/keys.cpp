// Prints docs/keys.md: every key of problem, robot and campaign files, from the tables that also read them.

#include <fmt/core.h>

#include "downwash/problems/key_reference.hpp"

using namespace downwash;

namespace {

void print_table(FileKind kind) {
    fmt::print("| key | expected | default | meaning |\n| --- | --- | --- | --- |\n");
    for (const KeyReference& key : key_reference(kind)) {
        const std::string condition = key.info.condition.empty() ? "" : " (" + key.info.condition + ")";
        fmt::print("| `{}` | {} | {} | {}{} |\n", key.info.path, expectation(key.info), key.default_text,
                   key.info.description, condition);
    }
}

}  // namespace

int main() {
    fmt::print(
        "# Keys of problem, robot and campaign files\n\n"
        "Printed from the tables that read them (`cmake --build build --target docs`). Angles are degrees in files. "
        "`[]` stands for\nthe elements of a list. A robot may stand inline or in a file of its own with "
        "`schema: downwash/robot/v1`.\n\n"
        "`downwash explain KEY` says the same of one key; `downwash check --schema problem` (or robot, campaign) "
        "prints a JSON "
        "Schema,\nby which editors complete and check these files.\n\n");
    print_table(FileKind::problem);
    fmt::print(
        "\n## Campaigns\n\nWhat `downwash bench run` reads ([benchmarking.md](benchmarking.md)). Limits stand for "
        "those of "
        "the problem files.\n\n");
    print_table(FileKind::campaign);
}
