#include "downwash/cli/commands.hpp"

namespace downwash::cli {

void add_aeromap(CLI::App& program, Action& action) {
    CLI::App* aeromap = program.add_subcommand("aeromap", "How surfaces change the thrust of a rotor");
    aeromap->require_subcommand(1);
    add_aeromap_query(*aeromap, action);
    add_aeromap_build(*aeromap, action);
    add_aeromap_info(*aeromap, action);
    add_aeromap_plot(*aeromap, action);
    add_aeromap_fit(*aeromap, action);
    add_aeromap_compare(*aeromap, action);
    add_aeromap_hold(*aeromap, action);
}

}  // namespace downwash::cli
