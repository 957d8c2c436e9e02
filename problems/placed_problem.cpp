#include "downwash/problems/placed_problem.hpp"

#include <algorithm>
#include <cctype>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "downwash/base/text.hpp"
#include "downwash/problems/key_remedy.hpp"
#include "downwash/problems/problem_check.hpp"
#include "downwash/problems/problem_parameters.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/problems/space_problem_parameters.hpp"
#include "downwash/problems/space_problem_writer.hpp"
#include "downwash/problems/tree_reader.hpp"
#include "downwash/problems/value_reader.hpp"
#include "downwash/problems/yaml_document.hpp"

namespace downwash {
namespace {

using ProblemTreeReader = problems::TreeReader<Problem>;

PlacedProblem placed_problem(const std::shared_ptr<ProblemTreeReader>& reader) {
    const ProblemCheck check(reader->model());
    if (!reader->is_full()) {
        reader->add(further_errors(check, reader->wrong_keys()));
    }
    if (auto errors = reader->errors(); !errors.empty()) {
        throw ProblemFileError(std::move(errors));
    }
    PlacedProblem problem{{reader->model(), model_of(check)}, reader->outdated_keys(), {}, {}};
    problem.placed = [reader](const std::vector<KeyError>& remarks) { return reader->placed(remarks); };
    problem.warnings = problem.placed(warnings_of(check));
    return problem;
}

/// A key as in the table: "environment.obstacles[].name" of "environment.obstacles[2].name".
std::string without_indices(std::string_view key) {
    std::string path;
    for (const char letter : key) {
        const bool is_index = std::isdigit(static_cast<unsigned char>(letter)) != 0 && path.ends_with('[');
        path += is_index ? "" : std::string(1, letter);
    }
    return path;
}

/// Why a problem has no value of that key.
template <class Model>
std::string why_absent(const ParameterTable<Model>& table, const std::string& key) {
    const std::string path = without_indices(key);
    if (const Parameter<Model>* known = table.find(path)) {
        if (!known->get) {
            return "is a group of keys, which has no value of its own";
        }
        return "is no key of this problem as it is" +
               (known->condition.empty() ? ": its group is not there" : ": it has a meaning only " + known->condition);
    }
    std::vector<std::string_view> valid;
    for (const Parameter<Model>* child : table.children(parent_path(path))) {
        valid.push_back(last_name(child->path));
    }
    const std::string remedy =
        valid.empty() ? "" : ": " + problems::remedy_for_key(std::string(last_name(path)), valid).text;
    return "is no key of a problem" + remedy;
}

/// One value, which may be null: as a document of its own that would be an empty one.
/// @throws YamlError
problems::YamlNode::Pointer node_of(const std::string& yaml) {
    const problems::YamlNode::Pointer list = problems::parse_yaml("[" + yaml + "]");
    if (list->items.size() != 1) {
        throw problems::YamlError({}, "is '" + excerpt(yaml) + "': expected one value");
    }
    return list->items.front();
}

/// Sets one value. @throws InputError
template <class Model>
void set_value(const ParameterTable<Model>& table, Model& problem, const KeyChange& change) {
    const Parameter<Model>* row = nullptr;
    std::size_t index = 0;
    for_each_value(table, problem, [&](const Parameter<Model>& parameter, const std::string& key, std::size_t at) {
        if (key == change.key) {
            row = &parameter;
            index = at;
        }
    });
    if (row == nullptr) {
        throw InputError({{change.key, why_absent(table, change.key)}});
    }
    const ParameterInfo& known = *row;
    ParameterInfo info = known;
    info.can_be_group = false;  // it is no value
    try {
        row->set(problem, index, problems::read_value(info, *node_of(change.yaml)));
    } catch (const problems::YamlError& error) {
        throw InputError({{change.key, error.what()}});
    }
}

/// Sets all of them. @throws InputError with every change that is none
template <class Model>
Model with_changes(const ParameterTable<Model>& table, Model problem, std::span<const KeyChange> changes) {
    std::vector<KeyError> errors;
    for (const KeyChange& change : changes) {
        try {
            set_value(table, problem, change);
        } catch (const InputError& error) {
            append(errors, error.errors());
        }
    }
    throw_if_any(std::move(errors));
    return problem;
}

using SpaceTreeReader = problems::TreeReader<SpaceProblem>;

PlacedSpaceProblem placed_problem(const std::shared_ptr<SpaceTreeReader>& reader) {
    if (!reader->is_full()) {
        reader->add(further_space_problem_errors(reader->model(), reader->wrong_keys()));
    }
    if (auto errors = reader->errors(); !errors.empty()) {
        throw ProblemFileError(std::move(errors));
    }
    PlacedSpaceProblem problem{
        std::make_shared<const SpaceProblemModel>(reader->model()), reader->outdated_keys(), {}, {}};
    problem.placed = [reader](const std::vector<KeyError>& remarks) { return reader->placed(remarks); };
    problem.warnings = problem.placed(space_problem_warnings(reader->model()));
    return problem;
}

using Json = nlohmann::ordered_json;

/// What stands in a document without quotes.
Json json_of_word(const std::string& word) {
    if (word == "true" || word == "false") {
        return word == "true";
    }
    if (const auto whole = parse_number<std::uint64_t>(word)) {
        return *whole;
    }
    const auto number = parse_number<double>(word);
    return number ? Json(*number) : Json(word);
}

/// A value of a document that we wrote: text is in quotes, but for words that are no numbers.
Json json_of(const problems::YamlNode& node) {
    using Kind = problems::YamlNode::Kind;
    Json json;
    switch (node.kind) {
        case Kind::null:
            break;
        case Kind::list:
            json = Json::array();
            for (const auto& item : node.items) {
                json.push_back(json_of(*item));
            }
            break;
        case Kind::map:
            json = Json::object();
            for (const auto& [key, value] : node.entries) {
                json[key->text] = json_of(*value);
            }
            break;
        case Kind::scalar:
            json = node.is_quoted ? Json(node.text) : json_of_word(node.text);
    }
    return json;
}

/// @throws ProblemFileError with every value that is wrong by itself
template <class Model>
Model values_in(const ParameterTable<Model>& table, const std::string& text, const std::filesystem::path& file) {
    problems::TreeReader<Model> reader(table);
    reader.read_text(text, file);
    if (auto errors = reader.errors(); !errors.empty()) {
        throw ProblemFileError(std::move(errors));
    }
    return reader.model();
}

}  // namespace

PlacedProblem read_placed_problem(const std::filesystem::path& file) {
    auto reader = std::make_shared<ProblemTreeReader>(problem_parameters());
    reader->read(file);
    return placed_problem(reader);
}

PlacedProblem parse_problem(const std::string& text, const std::filesystem::path& file, bool leaves_out_inapplicable) {
    auto reader = std::make_shared<ProblemTreeReader>(problem_parameters());
    if (leaves_out_inapplicable) {
        reader->leave_out_inapplicable();
    }
    reader->read_text(text, file);
    return placed_problem(reader);
}

Problem parse_values(const std::string& text, const std::filesystem::path& file) {
    return values_in(problem_parameters(), text, file);
}

SpaceProblem parse_space_values(const std::string& text, const std::filesystem::path& file) {
    return values_in(space_problem_parameters(), text, file);
}

PlacedProblem changed_problem(const PlacedProblem& before, std::span<const KeyChange> changes) {
    const Problem problem = with_changes(problem_parameters(), before.plannable.problem, changes);
    const ProblemCheck check(problem);
    if (const auto found = further_errors(check, {}); !found.empty()) {
        throw ProblemFileError(before.placed(found));
    }
    return {{problem, model_of(check)}, {}, before.placed(warnings_of(check)), before.placed};
}

PlacedSpaceProblem read_placed_space_problem(const std::filesystem::path& file) {
    auto reader = std::make_shared<SpaceTreeReader>(space_problem_parameters());
    reader->read(file);
    return placed_problem(reader);
}

PlacedSpaceProblem parse_space_problem(const std::string& text, const std::filesystem::path& file,
                                       bool leaves_out_inapplicable) {
    auto reader = std::make_shared<SpaceTreeReader>(space_problem_parameters());
    if (leaves_out_inapplicable) {
        reader->leave_out_inapplicable();
    }
    reader->read_text(text, file);
    return placed_problem(reader);
}

PlacedSpaceProblem changed_problem(const PlacedSpaceProblem& before, std::span<const KeyChange> changes) {
    const SpaceProblem problem = with_changes(space_problem_parameters(), before.model->problem(), changes);
    if (const auto found = further_space_problem_errors(problem, {}); !found.empty()) {
        throw ProblemFileError(before.placed(found));
    }
    return {std::make_shared<const SpaceProblemModel>(problem),
            {},
            before.placed(space_problem_warnings(problem)),
            before.placed};
}

std::string effective_json(const Problem& problem, const std::filesystem::path& folder) {
    return json_of(*problems::parse_yaml(effective_yaml(problem, folder))).dump();
}

std::string effective_json(const SpaceProblem& problem, const std::filesystem::path& folder) {
    return json_of(*problems::parse_yaml(effective_yaml(problem, folder))).dump();
}

}  // namespace downwash
