#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/base/checks.hpp"
#include "downwash/base/parameter.hpp"

namespace downwash {

/// Every parameter of a Model as a tree of keys. Immutable after construction.
template <class Model>
class ParameterTable {
 public:
    /// @pre every group comes before its parameters
    explicit ParameterTable(std::vector<Parameter<Model>> rows) : rows_(std::move(rows)) {
        for (const Parameter<Model>& parameter : rows_) {
            children_[std::string(parent_path(parameter.path))].push_back(&parameter);
        }
    }
    ParameterTable(const ParameterTable&) = delete;
    ParameterTable& operator=(const ParameterTable&) = delete;

    [[nodiscard]] const std::vector<Parameter<Model>>& rows() const noexcept { return rows_; }

    /// The direct members of a group, in the order of the table. "" is the top, "path[]" the elements of a list.
    [[nodiscard]] const std::vector<const Parameter<Model>*>& children(std::string_view path) const {
        static const std::vector<const Parameter<Model>*> none;
        const auto found = children_.find(path);
        return found == children_.end() ? none : found->second;
    }

    /// The parameter of that path ("environment.obstacles[].name"); nullptr when there is none.
    [[nodiscard]] const Parameter<Model>* find(std::string_view path) const {
        for (const Parameter<Model>* parameter : children(parent_path(path))) {
            if (parameter->path == path) {
                return parameter;
            }
        }
        return nullptr;
    }

 private:
    std::vector<Parameter<Model>> rows_;
    std::map<std::string, std::vector<const Parameter<Model>*>, std::less<>> children_;
};

/// Calls visit(parameter, key, index) for every value that a model has now. The key contains the indices of lists.
template <class Model, class Visit>
void for_each_value(const ParameterTable<Model>& table, const Model& model, const Visit& visit,
                    std::string_view path = {}, const std::string& key = {}, std::size_t index = 0) {
    for (const Parameter<Model>* parameter : table.children(path)) {
        const std::string below = (key.empty() ? "" : key + ".") + std::string(last_name(parameter->path));
        if (parameter->applies && !parameter->applies(model, index)) {
            continue;
        }
        if (parameter->has_value(model, index)) {
            visit(*parameter, below, index);
        } else if (parameter->has_list(model, index)) {
            for (std::size_t i = 0; i < parameter->count(model, index); ++i) {
                for_each_value(table, model, visit, parameter->path + "[]", below + "[" + std::to_string(i) + "]",
                               element_index(index, i));
            }
        } else if (parameter->count && parameter->count(model, index) > 0) {
            for_each_value(table, model, visit, parameter->path, below, index);
        }
    }
}

/// Every value that is not finite, out of range or no known name, but for keys that are wrong already; what is found
/// is wrong from then on.
/// @param prefix of the model's keys within a larger whole, for example "robot."
template <class Model>
std::vector<KeyError> value_errors(const ParameterTable<Model>& table, const Model& model, std::string_view prefix,
                                   WrongKeys& wrong) {
    std::vector<KeyError> errors;
    for_each_value(table, model, [&](const Parameter<Model>& parameter, const std::string& key, std::size_t index) {
        const std::string full_key = std::string(prefix) + key;
        if (wrong.touch(full_key)) {
            return;
        }
        if (const auto error = value_error(parameter, parameter.get(model, index))) {
            errors.push_back({full_key, *error});
        }
    });
    wrong.add(errors);
    return errors;
}

}  // namespace downwash
