// The program downwash-identify.

#include "downwash/cli/identify_command.hpp"
#include "downwash/cli/program.hpp"

int main(int argc, char** argv) {
    using namespace downwash::cli;
    return run_part("identify", argc, argv,
                    [](Command program, Action& action) { add_identify(program, action, identify_robot); });
}
