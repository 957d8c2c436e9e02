#include "downwash/problems/problem_reader.hpp"

#include <utility>

#include "downwash/problems/problem_check.hpp"
#include "downwash/problems/problem_parameters.hpp"
#include "downwash/problems/touch_places.hpp"
#include "downwash/problems/tree_reader.hpp"
#include "downwash/problems/value_reader.hpp"
#include "downwash/simulation/robot_parameters.hpp"

namespace downwash {
namespace {

using ProblemTreeReader = problems::TreeReader<Problem>;

void throw_errors(const ProblemTreeReader& reader) {
    if (auto errors = reader.errors(); !errors.empty()) {
        throw ProblemFileError(std::move(errors));
    }
}

/// Reads a problem and checks it as a whole. @return the check, of the reader's model
ProblemCheck read_checked(ProblemTreeReader& reader, const std::filesystem::path& file,
                          const std::function<void(Problem&)>& adjust) {
    reader.read(file);
    if (adjust) {
        reader.adjust(adjust);
    }
    ProblemCheck check(reader.model());
    if (!reader.is_full()) {
        reader.add(further_errors(check, reader.wrong_keys()));
    }
    throw_errors(reader);
    reader.adjust([](Problem& problem) { problem = with_touches(std::move(problem)); });
    return check;
}

/// Tells of outdated keys and warnings. @param on_outdated,on_warning may be empty
void tell(ProblemTreeReader& reader, const ProblemCheck& check,
          const std::function<void(const LocatedError&)>& on_outdated,
          const std::function<void(const LocatedError&)>& on_warning) {
    for (const LocatedError& key : reader.outdated_keys()) {
        if (on_outdated) {
            on_outdated(key);
        }
    }
    if (on_warning) {
        for (const LocatedError& warning : reader.placed(warnings_of(check))) {
            on_warning(warning);
        }
    }
}

}  // namespace

Problem read_problem(const std::filesystem::path& file, const std::function<void(Problem&)>& adjust,
                     const std::function<void(const LocatedError&)>& on_outdated,
                     const std::function<void(const LocatedError&)>& on_warning) {
    ProblemTreeReader reader(problem_parameters());
    const ProblemCheck check = read_checked(reader, file, adjust);
    tell(reader, check, on_outdated, on_warning);
    return reader.model();
}

PlannableProblem read_plannable_problem(const std::filesystem::path& file, const std::function<void(Problem&)>& adjust,
                                        const std::function<void(const LocatedError&)>& on_outdated,
                                        const std::function<void(const LocatedError&)>& on_warning) {
    ProblemTreeReader reader(problem_parameters());
    const ProblemCheck check = read_checked(reader, file, adjust);
    tell(reader, check, on_outdated, on_warning);
    return {reader.model(), model_of(check)};
}

ProblemReading examine_problem(const std::filesystem::path& file) {
    ProblemTreeReader reader(problem_parameters());
    reader.read(file);
    const ProblemCheck check(reader.model());
    ProblemReading reading;
    if (!reader.is_full()) {
        reading.wrong = reader.wrong_keys();
        const std::vector<KeyError> found = further_errors(check, reading.wrong);
        reader.add(found);
        reading.wrong.add(found);
        if (!reading.wrong.touch("environment.obstacles")) {
            reading.scene = check.scene();
        }
        if (!reading.wrong.touch("environment") && !reading.wrong.touch("robot") && !reading.wrong.touch("aero")) {
            reading.model = model_of(check);
        }
    }
    reading.errors = reader.errors();
    reading.warnings = reader.outdated_keys();
    const bool is_sound = reading.errors.empty();
    if (is_sound) {
        reader.adjust([](Problem& problem) { problem = with_touches(std::move(problem)); });
    }
    if (!reader.is_full()) {
        const auto found = reader.placed(is_sound ? warnings_of(check) : file_warnings_of(check, reading.wrong));
        reading.warnings.insert(reading.warnings.end(), found.begin(), found.end());
    }
    reading.problem = reader.model();
    return reading;
}

Robot read_robot(const std::filesystem::path& file, const std::function<void(const LocatedError&)>& on_warning) {
    ProblemTreeReader reader(problem_parameters());
    reader.read(file, "robot");
    if (!reader.is_full()) {
        WrongKeys wrong = reader.wrong_keys();
        reader.add(further_robot_errors(reader.model().robot, wrong, "robot."));
    }
    throw_errors(reader);
    if (on_warning) {
        for (const LocatedError& key : reader.outdated_keys()) {
            on_warning(key);
        }
        std::vector<KeyError> warnings = robot_warnings(reader.model().robot);
        for (KeyError& warning : warnings) {
            warning.key.insert(0, "robot.");
        }
        for (const LocatedError& warning : reader.placed(warnings)) {
            on_warning(warning);
        }
    }
    return reader.model().robot;
}

void set_parameter(Problem& problem, std::string_view key, std::string_view text) {
    const Parameter<Problem>* parameter = problem_parameters().find(key);
    if (parameter == nullptr || !parameter->set || key.find("[]") != std::string_view::npos) {
        throw InputError({{std::string(key), "is no key of a problem with one value"}});
    }
    const Parameter<Problem>* group = problem_parameters().find(parent_path(key));
    if (group != nullptr && group->exclusive && group->count(problem, 0) == 0) {
        throw InputError({{std::string(key), "is no key of this problem as it is: its group is not there"}});
    }
    problems::YamlNode node;
    node.kind = text == "null" ? problems::YamlNode::Kind::null : problems::YamlNode::Kind::scalar;
    node.text = text;
    try {
        const ParameterInfo& known = *parameter;
        ParameterInfo info = known;
        info.can_be_group = false;  // of which one text says nothing
        parameter->set(problem, 0, problems::read_value(info, node));
    } catch (const problems::YamlError& error) {
        throw InputError({{std::string(key), error.what()}});
    }
}

}  // namespace downwash
