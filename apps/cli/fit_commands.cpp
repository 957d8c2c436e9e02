#include "downwash/cli/fit_commands.hpp"

#include "downwash/cli/common_options.hpp"
#include "downwash/cli/model_option.hpp"

namespace downwash::cli {

Command add_aeromap_group(Command program) {
    Command aeromap = program.add_command("aeromap", "Show how surfaces change the thrust of a rotor");
    aeromap.require_command();
    return aeromap;
}

void add_aeromap_fit(Command aeromap, Action& action, ExitCode (*run)(const FitArguments&)) {
    auto [command, given] =
        add_command(aeromap, action, "fit", "Fit the parameters of a model to measurements by least squares", run);
    given.data.add_options(command);
    offer_models(command.add_option("--model NAME", given.model, "name of a model as in a problem file"));
    command.add_flag("--tilt-loss", given.of_tilt,
                     "fit the tilt loss instead of a model, beside the measurements without tilt");
    command.add_flag("--walls", given.of_walls, "fit force and moment beside a wall instead of a model");
    command.add_option("--fix NAME=VALUE", given.fixed, "keep a parameter at a value; may be repeated").repeated();
    command.add_flag("--weighted", given.is_weighted, "weight each residual by 1 / sigma, a column of DATA");
    add_out(command, "FILE", given.picture, "a picture of measurements, curve and residuals, .svg, .png or .pdf");
    add_json(command, given.as_json);
}

void add_aeromap_compare(Command aeromap, Action& action, ExitCode (*run)(const CompareArguments&)) {
    auto [command, given] =
        add_command(aeromap, action, "compare",
                    "Compare all models with measurements, each with the parameters of its source and refitted", run);
    add_data_files(command, given.files);
    given.data.add_selection(command);
    add_json(command, given.as_json);
    command.add_flag("--markdown", given.as_markdown, "Markdown instead of text; tables");
}

}  // namespace downwash::cli
