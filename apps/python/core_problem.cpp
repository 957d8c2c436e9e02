#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/key_reference.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/problems/space_problem_writer.hpp"
#include "downwash/python/columns.hpp"
#include "downwash/python/core.hpp"
#include "downwash/simulation/space_world_parameters.hpp"
#include "downwash/simulation/world_parameters.hpp"

namespace downwash::python {
namespace {

using Remarks = std::vector<std::tuple<std::string, int, int, std::string>>;

Remarks remarks_of(const std::vector<LocatedError>& remarks) {
    Remarks list;
    list.reserve(remarks.size());
    for (const LocatedError& each : remarks) {
        list.emplace_back(each.file, each.line, each.column, each.message);
    }
    return list;
}

/// @param before a CoreProblem or a CoreSpaceProblem
template <class Core>
Core changed(const Core& before, const std::vector<std::pair<std::string, std::string>>& changes) {
    std::vector<KeyChange> list;
    list.reserve(changes.size());
    for (const auto& [key, yaml] : changes) {
        list.push_back({key, yaml});
    }
    return {changed_problem(before.placed, list), before.file};
}

void require_uncertainty(const std::optional<Uncertainty>& uncertainty) {
    if (!uncertainty) {
        throw_input_error("need to know what is uncertain: the problem has no `uncertainty:`", "worlds");
    }
}

/// What the worlds 1 to `count` have otherwise than the nominal one, one row each.
py::dict drawn_worlds(const CoreProblem& of, std::uint64_t count, const std::optional<std::uint64_t>& seed) {
    const Problem& problem = of.problem();
    require_uncertainty(problem.uncertainty);
    std::vector<const WorldParameter*> parameters;
    NumberTable table;
    table.names.emplace_back("world");
    for (const WorldParameter* each : world_parameters_of(problem.robot)) {
        if (each->value != nullptr || each->rotor < of.model()->tick().plant.rotor_count) {
            parameters.push_back(each);
            table.names.emplace_back(each->name);
        }
    }
    table.columns.resize(table.names.size());
    for (std::uint64_t i = 1; i <= count; ++i) {
        const World world = draw_world(*problem.uncertainty, problem.robot, seed.value_or(problem.planner.seed), i);
        std::vector<double> row{static_cast<double>(i)};
        for (const WorldParameter* each : parameters) {
            row.push_back(each->of(world));
        }
        table.add_row(row);
    }
    return columns_of(std::move(table));
}

py::dict drawn_space_worlds(const CoreSpaceProblem& of, std::uint64_t count, const std::optional<std::uint64_t>& seed) {
    const SpaceProblem& problem = of.problem();
    require_uncertainty(problem.uncertainty);
    const std::vector<const SpaceWorldParameter*> parameters = space_world_parameters_of(problem.robot);
    NumberTable table;
    table.names.emplace_back("world");
    for (const SpaceWorldParameter* each : parameters) {
        table.names.push_back(each->name);
    }
    table.columns.resize(table.names.size());
    for (std::uint64_t i = 1; i <= count; ++i) {
        const SpaceWorld world =
            draw_space_world(*problem.uncertainty, problem.robot, seed.value_or(problem.planner.seed), i);
        std::vector<double> row{static_cast<double>(i)};
        for (const SpaceWorldParameter* each : parameters) {
            row.push_back(each->of(world));
        }
        table.add_row(row);
    }
    return columns_of(std::move(table));
}

/// The path that a wrong one most likely stands for, by all of it or by its last name; empty if none is near.
std::string_view nearest_path(std::string_view wrong) {
    std::vector<std::string_view> paths, names;
    for (const KeyReference& key : key_reference(FileKind::problem)) {
        paths.emplace_back(key.info.path);
        names.push_back(last_name(key.info.path));
    }
    if (const std::string_view path = nearest_name(wrong, paths); !path.empty()) {
        return path;
    }
    const std::string_view name = nearest_name(last_name(wrong), names);
    const auto found = name.empty() ? names.end() : std::find(names.begin(), names.end(), name);
    return found == names.end() ? std::string_view() : paths[static_cast<std::size_t>(found - names.begin())];
}

/// What the parameter table says of a key: meaning, expected value and default.
py::dict explained(const std::string& path) {
    for (const FileKind kind : {FileKind::problem, FileKind::space_problem}) {
        for (const KeyReference& key : key_reference(kind)) {
            if (key.info.path == path) {
                py::dict text;
                text["description"] = key.info.description;
                text["expected"] = expectation(key.info);
                text["default"] = key.default_text;
                return text;
            }
        }
    }
    const std::string_view nearest = nearest_path(path);
    throw_input_error(
        "is no key of a problem file" + (nearest.empty() ? "" : "; did you mean '" + std::string(nearest) + "'?"),
        path);
}

using AnyCore = std::variant<std::shared_ptr<CoreProblem>, std::shared_ptr<CoreSpaceProblem>>;

AnyCore read_any(const std::string& file) {
    if (is_space_problem_file(file)) {
        return std::make_shared<CoreSpaceProblem>(CoreSpaceProblem{read_placed_space_problem(file), file});
    }
    return std::make_shared<CoreProblem>(CoreProblem{read_placed_problem(file), file});
}

AnyCore parse_any(const std::string& text, const std::string& file, bool leaves_out_inapplicable) {
    if (is_space_problem_text(text)) {
        return std::make_shared<CoreSpaceProblem>(
            CoreSpaceProblem{parse_space_problem(text, file, leaves_out_inapplicable), file});
    }
    return std::make_shared<CoreProblem>(CoreProblem{parse_problem(text, file, leaves_out_inapplicable), file});
}

std::vector<std::string> joint_names(const CoreProblem& /*of*/) {
    return {"arm"};
}
std::vector<std::string> joint_names(const CoreSpaceProblem& of) {
    std::vector<std::string> names;
    for (int i = 1; i <= of.problem().robot.joints(); ++i) {
        names.push_back("joint_" + std::to_string(i));
    }
    return names;
}

std::size_t rotor_count(const CoreProblem& of) {
    return of.problem().robot.rotors.positions_m.size();
}
std::size_t rotor_count(const CoreSpaceProblem& of) {
    return of.problem().robot.plant.rotors.size();
}

/// What problems of both families have.
template <class Core>
void bind_class(py::module_& module, const char* name) {
    py::class_<Core, std::shared_ptr<Core>>(module, name)
        .def("changed", changed<Core>)
        .def("json", [](const Core& of, const std::string& folder) { return effective_json(of.problem(), folder); })
        .def("yaml", [](const Core& of, const std::string& folder) { return effective_yaml(of.problem(), folder); })
        .def("sha256", [](const Core& of) { return problem_sha256(of.problem()); })
        .def_readonly("file", &Core::file)
        .def_property_readonly("name", [](const Core& of) { return of.problem().name; })
        .def_property_readonly("joints", [](const Core& of) { return joint_names(of); })
        .def_property_readonly("rotors", [](const Core& of) { return rotor_count(of); })
        .def_property_readonly("warnings", [](const Core& of) { return remarks_of(of.placed.warnings); })
        .def_property_readonly("outdated", [](const Core& of) { return remarks_of(of.placed.outdated); });
}

}  // namespace

void bind_problem(py::module_& module) {
    bind_class<CoreProblem>(module, "Problem");
    bind_class<CoreSpaceProblem>(module, "SpaceProblem");
    module.def("read_problem", read_any);
    module.def("parse_problem", parse_any);
    module.def("explained", explained);
    module.def("draw_worlds", drawn_worlds);
    module.def("draw_worlds", drawn_space_worlds);
}

}  // namespace downwash::python
