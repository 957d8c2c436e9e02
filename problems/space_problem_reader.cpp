#include "downwash/problems/space_problem_reader.hpp"

#include <utility>

#include "downwash/base/files.hpp"
#include "downwash/problems/slip_warnings.hpp"
#include "downwash/problems/space_problem_parameters.hpp"
#include "downwash/problems/text_checks.hpp"
#include "downwash/problems/tree_reader.hpp"
#include "downwash/problems/vehicle_family.hpp"
#include "downwash/problems/yaml_document.hpp"
#include "downwash/simulation/space_robot_parameters.hpp"

namespace downwash {
namespace {

using SpaceTreeReader = problems::TreeReader<SpaceProblem>;

/// The document in a text; nullptr if there is none.
problems::YamlNode::Pointer document_of(const std::string& text) {
    try {
        return problems::parse_yaml(text);
    } catch (const problems::YamlError&) {
        return nullptr;
    }
}

/// The document in a file; nullptr if there is none.
problems::YamlNode::Pointer document_in(const std::filesystem::path& file) {
    try {
        return document_of(read_file(file, problems::largest_document + 1));
    } catch (const FileError&) {
        return nullptr;
    }
}

bool is_space_problem(const problems::YamlNode::Pointer& document) {
    return document != nullptr && problems::family_keys_of_problem(*document).space.has_value();
}

void throw_errors(const SpaceTreeReader& reader) {
    if (auto errors = reader.errors(); !errors.empty()) {
        throw ProblemFileError(std::move(errors));
    }
}

/// Tells of outdated keys and warnings, if anybody listens.
void tell(SpaceTreeReader& reader, const std::vector<KeyError>& warnings,
          const std::function<void(const LocatedError&)>& on_warning) {
    for (const LocatedError& key : reader.outdated_keys()) {
        on_warning(key);
    }
    for (const LocatedError& warning : reader.placed(warnings)) {
        on_warning(warning);
    }
}

}  // namespace

bool is_space_problem_file(const std::filesystem::path& file) {
    return is_space_problem(document_in(file));
}

bool is_space_problem_text(const std::string& text) {
    return is_space_problem(document_of(text));
}

bool is_space_robot_file(const std::filesystem::path& file) {
    const auto document = document_in(file);
    return document != nullptr && problems::family_keys_of_robot(*document).space.has_value();
}

SpaceProblem read_space_problem(const std::filesystem::path& file, const std::function<void(SpaceProblem&)>& adjust,
                                const std::function<void(const LocatedError&)>& on_warning,
                                const std::function<std::vector<KeyError>(const SpaceProblem&)>& further_errors) {
    SpaceTreeReader reader(space_problem_parameters());
    reader.read(file);
    if (adjust) {
        reader.adjust(adjust);
    }
    if (!reader.is_full()) {
        reader.add(further_space_problem_errors(reader.model(), reader.wrong_keys()));
    }
    if (further_errors && reader.errors().empty()) {
        reader.add(further_errors(reader.model()));
    }
    throw_errors(reader);
    if (on_warning) {
        tell(reader, space_problem_warnings(reader.model()), on_warning);
    }
    return reader.model();
}

SpaceRobot read_space_robot(const std::filesystem::path& file,
                            const std::function<void(const LocatedError&)>& on_warning) {
    SpaceTreeReader reader(space_problem_parameters());
    reader.read(file, "robot");
    if (!reader.is_full()) {
        WrongKeys wrong = reader.wrong_keys();
        reader.add(further_space_robot_errors(reader.model().robot, wrong, "robot."));
    }
    throw_errors(reader);
    if (on_warning) {
        std::vector<KeyError> warnings = space_robot_warnings(reader.model().robot);
        append(warnings, robot_slips(reader.model().robot));
        for (KeyError& warning : warnings) {
            warning.key.insert(0, "robot.");
        }
        tell(reader, warnings, on_warning);
    }
    return reader.model().robot;
}

}  // namespace downwash
