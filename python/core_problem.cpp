#include <pybind11/stl.h>

#include <utility>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/problems/algorithms.hpp"
#include "downwash/problems/key_reference.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/python/core.hpp"

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
    throw_input_error("is no key of a problem file", path);
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
}

}  // namespace downwash::python
