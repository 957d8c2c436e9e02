// The program downwash-validate.

#include "downwash/cli/program.hpp"
#include "downwash/cli/validate_command.hpp"

int main(int argc, char** argv) {
    using namespace downwash::cli;
    return run_part("validate", argc, argv,
                    [](Command program, Action& action) { add_validate(program, action, validate); });
}
