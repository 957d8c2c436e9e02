#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <array>
#include <string_view>

#include "downwash/cli/common_options.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/study_commands.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/studies/ceiling_contact.hpp"
#include "downwash/studies/ceiling_envelope.hpp"
#include "downwash/studies/disturbance_test_bench.hpp"
#include "downwash/studies/partial_ground_effect.hpp"
#include "downwash/studies/study_files.hpp"

namespace downwash::cli {
namespace {

struct NamedStudy {
    std::string_view name;
    studies::Study (*make)();
};

constexpr std::array thesis_studies{
    NamedStudy{"ceiling-envelope", studies::ceiling_envelope},
    NamedStudy{"ceiling-contact", studies::ceiling_contact},
    NamedStudy{"partial-ground-effect", studies::partial_ground_effect},
    NamedStudy{"disturbance-test-bench", studies::disturbance_test_bench},
};

}  // namespace

ExitCode study_thesis(const StudyArguments& given) {
    const OutputFolder folder(given.out);
    const studies::Study study = entry_named(thesis_studies, given.name, "study").make();
    write_together(folder.path(), studies::files_of(study));
    if (given.as_json) {
        fmt::print("{}\n", studies::json_of(study));
    } else if (!given.is_quiet) {
        fmt::print("{}", studies::markdown_of(study));
    }
    return ExitCode::done;
}

}  // namespace downwash::cli
