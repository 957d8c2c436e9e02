#include "downwash/problems/problem_reader.hpp"

#include <utility>

#include "downwash/problems/tree_reader.hpp"
#include "downwash/problems/value_reader.hpp"
#include "downwash/simulation/robot_parameters.hpp"

namespace downwash {
namespace {

std::string joined(const std::vector<LocatedFault>& faults) {
    std::string text;
    for (const LocatedFault& fault : faults) {
        text += (text.empty() ? "" : "\n") + to_text(fault);
    }
    return text;
}

void throw_faults(const problems::TreeReader& reader) {
    if (auto faults = reader.faults(); !faults.empty()) {
        throw ProblemFileError(std::move(faults));
    }
}

}  // namespace

std::string to_text(const LocatedFault& fault) {
    return fault.file + ":" + std::to_string(fault.line) + ":" + std::to_string(fault.column) + ": " + fault.message;
}

ProblemFileError::ProblemFileError(std::vector<LocatedFault> faults)
    : std::runtime_error(joined(faults)), faults_(std::move(faults)) {}

Problem read_problem(const std::filesystem::path& file, const std::function<void(Problem&)>& adjust) {
    problems::TreeReader reader;
    reader.read_problem_file(file);
    if (adjust) {
        reader.adjust(adjust);
    }
    if (!reader.is_full()) {
        reader.add(further_problem_faults(reader.problem(), reader.faulty_keys()));
    }
    throw_faults(reader);
    return reader.problem();
}

Robot read_robot(const std::filesystem::path& file) {
    problems::TreeReader reader;
    reader.read_robot_file(file);
    if (!reader.is_full()) {
        FaultyKeys faulty = reader.faulty_keys();
        reader.add(further_robot_faults(reader.problem().robot, faulty, "robot."));
    }
    throw_faults(reader);
    return reader.problem().robot;
}

void set_parameter(Problem& problem, std::string_view key, std::string_view text) {
    const Parameter<Problem>* parameter = problem_parameters().find(key);
    if (parameter == nullptr || !parameter->set || key.find("[]") != std::string_view::npos) {
        throw InputError({{std::string(key), "is no key of a problem with one value"}});
    }
    problems::YamlNode node;
    node.kind = text == "null" ? problems::YamlNode::Kind::null : problems::YamlNode::Kind::scalar;
    node.text = text;
    try {
        ParameterInfo info = *parameter;
        info.can_be_group = false;  // of which one text says nothing
        parameter->set(problem, 0, problems::read_value(info, node));
    } catch (const problems::YamlError& error) {
        throw InputError({{std::string(key), error.what()}});
    }
}

}  // namespace downwash
