#include "downwash/problems/tree_reader.hpp"

#include <algorithm>
#include <tuple>
#include <type_traits>

#include "downwash/base/files.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/campaign.hpp"
#include "downwash/problems/foreign_file.hpp"
#include "downwash/problems/key_remedy.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/problems/text_checks.hpp"
#include "downwash/problems/value_reader.hpp"
#include "downwash/problems/vehicle_family.hpp"
#include "downwash/problems/yaml_document.hpp"

namespace downwash::problems {
namespace {

constexpr std::size_t max_errors = 100;

std::string joined(const std::string& key, std::string_view name) {
    return key.empty() ? std::string(name) : key + "." + std::string(name);
}

/// What a key of a robot would be called if it were one of the problem; empty where nothing is a robot's.
std::string key_outside_robot(const std::string& path, std::string_view name) {
    constexpr std::string_view robot = "robot";
    if (path != robot && !path.starts_with("robot.")) {
        return {};
    }
    return joined(path == robot ? "" : path.substr(robot.size() + 1), name);
}

/// Whether a condition in words has the name of a key: "with controller.type lyapunov" has "type".
bool names(std::string_view condition, std::string_view name) {
    const auto is_part = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
    for (std::size_t at = condition.find(name); at != std::string_view::npos; at = condition.find(name, at + 1)) {
        const std::size_t end = at + name.size();
        if ((at == 0 || !is_part(condition[at - 1])) && (end == condition.size() || !is_part(condition[end]))) {
            return true;
        }
    }
    return false;
}

/// How to come by a group that nobody has thought about yet: a law whose gains all have defaults, or the program's own
/// proposal.
template <class Model>
std::string to_begin_with(std::string_view path) {
    if (path != "controller" && path != "robot.controller") {
        return "";
    }
    return std::is_same_v<Model, SpaceProblem> ? "; `downwash margins ROBOT --design` prints one for this robot"
                                               : ", to begin with {type: cascaded-pid}";
}

}  // namespace

template <class Model>
bool TreeReader<Model>::is_full() const noexcept {
    return found_.size() >= max_errors;
}

/// Reads a file as the group `path`; what keeps it from being read at all is reported where it was referred from.
template <class Model>
void TreeReader<Model>::read_document(const std::filesystem::path& file, const std::string& path,
                                      const Mark& referred_from) {
    const std::size_t referring_file = file_;
    std::string text;
    try {
        text = read_file(file, largest_document + 1);
    } catch (const FileError& error) {
        if (files_.empty()) {
            files_.push_back({file, path});
            report(path, {}, error.what());
        } else {
            report(path, referred_from, "'" + file.string() + "' " + error.what());
        }
        return;
    }
    const bool is_referred = !files_.empty();
    const std::string referrer =
        is_referred ? files_[file_].path.string() + ":" + std::to_string(referred_from.line) : "";
    read_text(text, file, path, referrer);
    file_ = referring_file;
}

/// Reads the text of a file as the group `path`. @param referrer the place that names the file; empty without one
template <class Model>
void TreeReader<Model>::read_text(const std::string& text, const std::filesystem::path& file, const std::string& path,
                                  const std::string& referrer) {
    files_.push_back({file, path});
    file_ = files_.size() - 1;
    places_[path] = {file_, {}};
    const std::string taken_for = referrer.empty() ? "" : "; " + referrer + " takes it for the " + path;
    try {
        const YamlNode::Pointer root = parse_yaml(text);
        if (root->kind != YamlNode::Kind::map) {
            const std::string foreign = foreign_file_text(file, text);
            report(
                path, root->mark,
                (foreign.empty() ? found_text(*root) + ": expected a file of keys and values" : foreign) + taken_for);
        } else if (has_supported_schema(*root, path) && !is_misfit(*root, path, path)) {
            read_keys({path, path, 0, {}, *root, {}, {}});
        }
    } catch (const YamlError& error) {
        if (const std::string foreign = foreign_file_text(file, text); !foreign.empty()) {
            report(path, {}, foreign + taken_for);
        } else {
            report(path, error.mark, error.what());
        }
    }
}

/// Under another schema every key could mean something else: nothing more is read then.
template <class Model>
bool TreeReader<Model>::has_supported_schema(const YamlNode& root, const std::string& path) {
    const Parameter<Model>& schema = *table_.find(joined(path, "schema"));
    const std::string expected(schema.names[0]);
    for (const auto& [key, value] : root.entries) {
        if (key->kind != YamlNode::Kind::scalar || key->text != "schema") {
            continue;
        }
        if (value->kind == YamlNode::Kind::scalar && value->text == expected) {
            return true;
        }
        report(path, value->mark, "schema " + found_text(*value) + ": expected " + expected + ", no other is read");
        return false;
    }
    if (!schema.required) {
        report(schema.path, {}, "is missing: expected 'schema: " + expected + "' at the top");
    }
    return true;
}

/// Nothing of a group is read that is of another kind of vehicle.
template <class Model>
bool TreeReader<Model>::is_misfit(const YamlNode& node, const std::string& path, const std::string& key) {
    const auto found = misfit<Model>(path, node);
    if (found) {
        wrong_.add(key);
        report(found->mark, found->what());
    }
    return found.has_value();
}

template <class Model>
void TreeReader<Model>::read_keys(Group group) {
    find_entries(group);
    for (const std::string& name : group.meant) {
        if (!group.entries.contains(name)) {
            wrong_.add(joined(group.key, name));
        }
    }
    check_alternatives(group);
    for (const Parameter<Model>* parameter : table_.children(group.path)) {
        const std::string name(last_name(parameter->path));
        if (group.entries.contains(name)) {
            read_parameter(group, *parameter);
        } else if (is_required(*parameter) && !is_undecided(group, *parameter) &&
                   (!parameter->applies || parameter->applies(model_, group.index)) &&
                   std::count(group.meant.begin(), group.meant.end(), name) == 0) {
            report(joined(group.key, name), group.mark,
                   "is missing: expected " + expectation(*parameter) + to_begin_with<Model>(parameter->path));
        }
    }
}

template <class Model>
void TreeReader<Model>::find_entries(Group& group) {
    for (std::size_t i = 0; i < group.node.entries.size() && !is_full(); ++i) {
        const YamlNode& key = *group.node.entries[i].first;
        if (key.kind != YamlNode::Kind::scalar) {
            report(key.mark, "a key of " + shown(group.key) + " is no word: expected 'name: value'");
            continue;
        }
        const std::string name = current_name(group, key);
        if (table_.find(joined(group.path, name)) == nullptr) {
            report_unknown(group, name, key.mark);
            continue;
        }
        const auto [first, is_new] = group.entries.emplace(name, i);
        if (!is_new) {
            const int line = group.node.entries[first->second].first->mark.line;
            report(joined(group.key, name), key.mark,
                   "is written twice: expected once, as in line " + std::to_string(line));
        }
    }
}

/// The name of a key, which the file may call by the name that it had in earlier versions.
template <class Model>
std::string TreeReader<Model>::current_name(const Group& group, const YamlNode& key) {
    for (const Parameter<Model>* child : table_.children(group.path)) {
        if (!child->former_name.empty() && child->former_name == key.text) {
            std::string name(last_name(child->path));
            outdated_.push_back(
                {{file_, key.mark}, shown(joined(group.key, key.text)) + " is now called " + name + ": rename it"});
            return name;
        }
    }
    return key.text;
}

/// The entry before that of a key, where its value is a whole number: "z_m: 9" of {z_m: 9,4}.
template <class Model>
std::optional<std::string> TreeReader<Model>::number_before_comma(const Group& group, const Mark& mark) {
    const auto& entries = group.node.entries;
    const auto is_there = [&](const auto& entry) {
        return entry.first->mark.line == mark.line && entry.first->mark.column == mark.column;
    };
    const auto found = std::ranges::find_if(entries, is_there);
    if (found == entries.begin() || found == entries.end()) {
        return std::nullopt;
    }
    const auto& [key, value] = *std::prev(found);
    const bool is_whole = key->kind == YamlNode::Kind::scalar && value->kind == YamlNode::Kind::scalar &&
                          value->mark.line == mark.line && value->text.find('.') == std::string::npos &&
                          parse_number<double>(value->text).has_value();
    return is_whole ? std::optional(key->text + ": " + value->text) : std::nullopt;
}

template <class Model>
void TreeReader<Model>::report_unknown(Group& group, const std::string& name, const Mark& mark) {
    std::vector<std::string_view> valid;
    for (const Parameter<Model>* child : table_.children(group.path)) {
        valid.push_back(last_name(child->path));
    }
    if (name == "<<") {
        report(mark,
               "merge keys (<<) are not read: expected the keys themselves; an alias (*name) may stand for a whole "
               "value");
        group.meant.insert(group.meant.end(), valid.begin(), valid.end());  // it may bring any of them
        return;
    }
    if (const auto before = number_before_comma(group, mark); before && parse_number<std::uint64_t>(name)) {
        report(mark,
               "unknown key '" + excerpt(name) + "': numbers have a decimal point; write " + *before + "." + name);
        return;
    }
    const std::string elsewhere = key_outside_robot(group.path, name);
    const KeyRemedy remedy = elsewhere.empty() || table_.find(elsewhere) == nullptr
                                 ? remedy_for_key(name, valid)
                                 : KeyRemedy{"it belongs in the problem file, as " + elsewhere, {}};
    const std::string where = shown(group.key);
    report(mark, "unknown key '" + excerpt(name) + "' " + (where.empty() ? "at the top" : "in " + where) + ": " +
                     remedy.text);
    group.meant.insert(group.meant.end(), remedy.meant.begin(), remedy.meant.end());
}

template <class Model>
void TreeReader<Model>::check_alternatives(const Group& group) {
    std::vector<std::string_view> names;
    std::vector<std::size_t> given;
    for (const Parameter<Model>* child : table_.children(group.path)) {
        if (!child->exclusive) {
            continue;
        }
        names.push_back(last_name(child->path));
        if (const auto entry = group.entries.find(names.back()); entry != group.entries.end()) {
            given.push_back(entry->second);
        }
    }
    if (names.empty()) {
        return;
    }
    std::sort(given.begin(), given.end());
    if (given.empty() && group.meant.empty()) {
        report(group.key, group.mark, "needs exactly one of " + joined_names(names));
    } else if (given.size() > 1) {
        const YamlNode& first = *group.node.entries[given[0]].first;
        const YamlNode& second = *group.node.entries[given[1]].first;
        report(group.key, second.mark,
               "has both " + first.text + " and " + second.text + ": expected exactly one of " + joined_names(names));
    } else if (given.empty()) {
        wrong_.add(group.key);
    }
}

/// Whether a key that decides where this one has a meaning is wrong itself, or misspelt.
template <class Model>
bool TreeReader<Model>::is_undecided(const Group& group, const Parameter<Model>& parameter) const {
    return std::ranges::any_of(table_.children(group.path), [&](const Parameter<Model>* other) {
        const std::string_view name = last_name(other->path);
        const bool is_misspelt = std::ranges::find(group.meant, name) != group.meant.end();
        const bool is_wrong = other->kind == ParameterKind::choice && wrong_.touch(joined(group.key, name));
        return (is_misspelt || is_wrong) && names(parameter.condition, name);
    });
}

template <class Model>
bool TreeReader<Model>::is_required(const Parameter<Model>& parameter) const {
    const auto is_below = [&](const std::string& path) {
        return parameter.path == path || parameter.path.starts_with(path + ".");
    };
    return parameter.required && !(may_lack_ && is_below(*may_lack_));
}

template <class Model>
void TreeReader<Model>::read_parameter(const Group& group, const Parameter<Model>& parameter) {
    const std::string name(last_name(parameter.path));
    const auto& [key_node, value] = group.node.entries[group.entries.at(name)];
    const std::string key = joined(group.key, name);
    if (is_full()) {
        return;
    }
    if (parameter.applies && !parameter.applies(model_, group.index)) {
        if (!leaves_out_inapplicable_ && !is_undecided(group, parameter)) {
            report(key, key_node->mark, "has a meaning only " + parameter.condition + ": remove it");
        }
        return;
    }
    switch (parameter.kind) {
        case ParameterKind::group:
            places_[key] = {file_, key_node->mark};
            read_group(parameter, *value, key, key_node->mark, group.index);
            break;
        case ParameterKind::list:
            places_[key] = {file_, key_node->mark};
            read_list(parameter, *value, key, group.index);
            break;
        default:
            places_[key] = {file_, value->mark};
            if (parameter.can_be_group && value->kind == YamlNode::Kind::map) {
                read_group(parameter, *value, key, key_node->mark, group.index);
                return;
            }
            read_single(parameter, *value, key, group.index);
    }
}

template <class Model>
void TreeReader<Model>::read_group(const Parameter<Model>& parameter, const YamlNode& node, const std::string& key,
                                   const Mark& key_mark, std::size_t index) {
    const bool is_text = node.kind == YamlNode::Kind::scalar;
    if (node.kind == YamlNode::Kind::map) {
        if (is_misfit(node, parameter.path, key)) {
            return;
        }
        parameter.resize(model_, index, 1);
        read_keys({parameter.path, key, index, key_mark, node, {}, {}});
    } else if (parameter.can_be_list && node.kind == YamlNode::Kind::list) {
        read_list(parameter, node, key, index);
    } else if (is_text && parameter.can_be_none && node.text == "none") {
        parameter.resize(model_, index, 0);
    } else if (is_text && parameter.can_be_file && !node.text.empty()) {
        read_document(path_from_here(node.text), parameter.path, node.mark);
    } else if (node.kind == YamlNode::Kind::list && parameter.can_be_integers) {
        read_single(parameter, node, key, index);
    } else {
        report(key, node.mark, found_text(node) + ": expected " + expectation(parameter));
    }
}

template <class Model>
void TreeReader<Model>::read_list(const Parameter<Model>& parameter, const YamlNode& node, const std::string& key,
                                  std::size_t index) {
    if (node.kind != YamlNode::Kind::list) {
        const std::string remedy = node.kind == YamlNode::Kind::null ? "; write [] for none" : "";
        report(key, node.mark, found_text(node) + ": expected " + expectation(parameter) + remedy);
        return;
    }
    if (node.items.empty() && (parameter.can_be_list || parameter.exclusive)) {
        report(key, node.mark, "is empty: expected one element at least");
        return;
    }
    parameter.resize(model_, index, node.items.size());
    for (std::size_t i = 0; i < node.items.size() && !is_full(); ++i) {
        const YamlNode& item = *node.items[i];
        const std::string item_key = key + "[" + std::to_string(i) + "]";
        places_[item_key] = {file_, item.mark};
        if (item.kind == YamlNode::Kind::map) {
            read_keys({parameter.path + "[]", item_key, element_index(index, i), item.mark, item, {}, {}});
        } else {
            report(item_key, item.mark, found_text(item) + ": expected a group of keys");
        }
    }
}

template <class Model>
void TreeReader<Model>::read_single(const Parameter<Model>& parameter, const YamlNode& node, const std::string& key,
                                    std::size_t index) {
    try {
        Value value = read_value(parameter, node);
        if (parameter.kind == ParameterKind::file && std::holds_alternative<std::string>(value)) {
            value = path_from_here(std::get<std::string>(value)).string();
        } else if (parameter.kind == ParameterKind::files) {
            for (std::string& path : std::get<std::vector<std::string>>(value)) {
                path = path_from_here(path).string();
            }
        }
        parameter.set(model_, index, value);
    } catch (const YamlError& error) {
        report(key, error.mark, error.what());
    } catch (const InputError& error) {
        for (const KeyError& found : error.errors()) {
            report(key, node.mark, found.message);
        }
    }
}

/// A path in the file that is read now, which it is relative to. Symbolic links forbid to shorten it.
template <class Model>
std::filesystem::path TreeReader<Model>::path_from_here(const std::string& path) const {
    return files_[file_].path.parent_path() / path;
}

template <class Model>
void TreeReader<Model>::report(const std::string& key, const Mark& mark, const std::string& message) {
    if (is_full()) {
        return;
    }
    wrong_.add(key);
    const std::string subject = shown(key);
    report(mark, subject.empty() ? message : subject + " " + message);
}

template <class Model>
void TreeReader<Model>::report(const Mark& mark, const std::string& message) {
    if (!is_full()) {
        found_.push_back({{file_, mark}, message});
    }
}

/// A key as the file that is read now would write it.
template <class Model>
std::string TreeReader<Model>::shown(const std::string& key) const {
    const std::string& root = files_[file_].root;
    if (root.empty() || !key.starts_with(root)) {
        return key;
    }
    return key.size() == root.size() ? "" : key.substr(root.size() + 1);
}

template <class Model>
typename TreeReader<Model>::Place TreeReader<Model>::place_of(std::string_view key) const {
    while (!key.empty()) {
        const auto found = places_.find(key);
        if (found != places_.end()) {
            return found->second;
        }
        const std::size_t cut = key.find_last_of(".[");
        key = cut == std::string_view::npos ? std::string_view{} : key.substr(0, cut);
    }
    return {0, {}};
}

template <class Model>
void TreeReader<Model>::add(const std::vector<KeyError>& errors) {
    for (const KeyError& later : errors) {
        const Place place = place_of(later.key);
        file_ = place.file;
        report(later.key, place.mark, later.message);
    }
    file_ = 0;
}

template <class Model>
std::vector<LocatedError> TreeReader<Model>::placed(const std::vector<KeyError>& remarks) {
    std::vector<Found> found;
    for (const KeyError& remark : remarks) {
        const Place place = place_of(remark.key);
        file_ = place.file;
        const std::string subject = shown(remark.key);
        found.push_back({place, (subject.empty() ? "" : subject + " ") + remark.message});
    }
    file_ = 0;
    return located(std::move(found));
}

template <class Model>
std::vector<LocatedError> TreeReader<Model>::errors() const {
    return located(found_);
}

template <class Model>
std::vector<LocatedError> TreeReader<Model>::located(std::vector<Found> findings) const {
    std::stable_sort(findings.begin(), findings.end(), [](const Found& a, const Found& b) {
        return std::tie(a.place.file, a.place.mark.line, a.place.mark.column) <
               std::tie(b.place.file, b.place.mark.line, b.place.mark.column);
    });
    std::vector<LocatedError> list;
    list.reserve(findings.size());
    for (const Found& found : findings) {
        list.push_back(
            {files_[found.place.file].path.string(), found.place.mark.line, found.place.mark.column, found.message});
    }
    return list;
}

template class TreeReader<Problem>;
template class TreeReader<SpaceProblem>;
template class TreeReader<Campaign>;

}  // namespace downwash::problems
