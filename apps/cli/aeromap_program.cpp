// The program downwash-aeromap: the commands of `aeromap` that need a solver of least squares.

#include "downwash/cli/fit_commands.hpp"
#include "downwash/cli/program.hpp"

int main(int argc, char** argv) {
    using namespace downwash::cli;
    return run_part("aeromap", argc, argv, [](Command program, Action& action) {
        Command aeromap = add_aeromap_group(program);
        add_aeromap_fit(aeromap, action, fit_model);
        add_aeromap_compare(aeromap, action, compare_models);
    });
}
