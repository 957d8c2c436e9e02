#include <fmt/core.h>

#include <string>

#include "downwash/cli/common_options.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/studies/ceiling_contact.hpp"
#include "downwash/studies/ceiling_envelope.hpp"
#include "downwash/studies/disturbance_test_bench.hpp"
#include "downwash/studies/partial_ground_effect.hpp"
#include "downwash/studies/study_files.hpp"

namespace downwash::cli {
namespace {

struct StudyArguments {
    studies::Study (*make_study)() = nullptr;
    std::string out;
    bool is_quiet = false, as_json = false;
};

ExitCode run(const StudyArguments& given) {
    const OutputFolder folder(given.out);
    const studies::Study study = given.make_study();
    write_together(folder.path(), studies::files_of(study));
    if (given.as_json) {
        fmt::print("{}\n", studies::json_of(study));
    } else if (!given.is_quiet) {
        fmt::print("{}", studies::markdown_of(study));
    }
    return ExitCode::done;
}

/// Adds a study of the thesis' experiments.
void add_thesis_study(Command parent, Action& action, const std::string& name, const std::string& about,
                      studies::Study (*make_study)()) {
    auto [command, given] = add_command(parent, action, name, about, run);
    given.make_study = make_study;
    given.out = "downwash-out/study-" + name;
    add_out(command, "DIR", given.out, "folder for the results; default downwash-out/study-" + name + "/");
    add_quiet(command, given.is_quiet);
    add_json(command, given.as_json);
}

}  // namespace

void add_thesis_studies(Command study, Action& action) {
    add_thesis_study(study, action, "ceiling-envelope",
                     "Compare the rotors of a pitched vehicle under a ceiling (thesis 4.6, figure 4.9)",
                     studies::ceiling_envelope);
    add_thesis_study(study, action, "ceiling-contact",
                     "Touch a ceiling and leave it under the Lyapunov laws and under a PID (thesis 4.6, 4.7)",
                     studies::ceiling_contact);
    add_thesis_study(
        study, action, "partial-ground-effect",
        "Fly a quadrotor over the edge of a plate under three controllers, with every ground model (thesis 3.4)",
        studies::partial_ground_effect);
    add_thesis_study(study, action, "disturbance-test-bench",
                     "Put a plate under one rotor of a quadrotor that can only pitch (thesis 3.5)",
                     studies::disturbance_test_bench);
}

}  // namespace downwash::cli
