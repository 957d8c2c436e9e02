// The program downwash-export.

#include "downwash/cli/export_command.hpp"
#include "downwash/cli/program.hpp"

int main(int argc, char** argv) {
    using namespace downwash::cli;
    return run_part("export", argc, argv,
                    [](Command program, Action& action) { add_export(program, action, export_run); });
}
