// The program downwash-compare.

#include "downwash/cli/compare_command.hpp"
#include "downwash/cli/program.hpp"

int main(int argc, char** argv) {
    using namespace downwash::cli;
    return run_part("compare", argc, argv,
                    [](Command program, Action& action) { add_compare(program, action, compare_with_log); });
}
