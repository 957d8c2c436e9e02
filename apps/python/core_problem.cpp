#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/key_reference.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/python/columns.hpp"
#include "downwash/python/core.hpp"
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

CoreProblem changed(const CoreProblem& before, const std::vector<std::pair<std::string, std::string>>& changes) {
    std::vector<KeyChange> list;
    list.reserve(changes.size());
    for (const auto& [key, yaml] : changes) {
        list.push_back({key, yaml});
    }
    return {changed_problem(before.placed, list), before.file};
}

/// What the worlds 1 to `count` have otherwise than the nominal one, one row each.
py::dict drawn_worlds(const CoreProblem& of, std::uint64_t count, const std::optional<std::uint64_t>& seed) {
    const Problem& problem = of.problem();
    if (!problem.uncertainty) {
        throw_input_error("need to know what is uncertain: the problem has no `uncertainty:`", "worlds");
    }
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
    for (const KeyReference& key : key_reference(FileKind::problem)) {
        if (key.info.path == path) {
            py::dict text;
            text["description"] = key.info.description;
            text["expected"] = expectation(key.info);
            text["default"] = key.default_text;
            return text;
        }
    }
    const std::string_view nearest = nearest_path(path);
    throw_input_error(
        "is no key of a problem file" + (nearest.empty() ? "" : "; did you mean '" + std::string(nearest) + "'?"),
        path);
}

}  // namespace

void bind_problem(py::module_& module) {
    py::class_<CoreProblem, std::shared_ptr<CoreProblem>>(module, "Problem")
        .def_static("read",
                    [](const std::string& file) {
                        return CoreProblem{read_placed_problem(file), file};
                    })
        .def_static("parse",
                    [](const std::string& text, const std::string& file, bool leaves_out_inapplicable) {
                        return CoreProblem{parse_problem(text, file, leaves_out_inapplicable), file};
                    })
        .def("changed", changed)
        .def("json",
             [](const CoreProblem& of, const std::string& folder) { return effective_json(of.problem(), folder); })
        .def("yaml",
             [](const CoreProblem& of, const std::string& folder) { return effective_yaml(of.problem(), folder); })
        .def("sha256", [](const CoreProblem& of) { return problem_sha256(of.problem()); })
        .def_readonly("file", &CoreProblem::file)
        .def_property_readonly("name", [](const CoreProblem& of) { return of.problem().name; })
        .def_property_readonly("rotors", [](const CoreProblem& of) { return of.model()->tick().plant.rotor_count; })
        .def_property_readonly("warnings", [](const CoreProblem& of) { return remarks_of(of.placed.warnings); })
        .def_property_readonly("outdated", [](const CoreProblem& of) { return remarks_of(of.placed.outdated); });
    module.def("explained", explained);
    module.def("draw_worlds", drawn_worlds);
}

}  // namespace downwash::python
