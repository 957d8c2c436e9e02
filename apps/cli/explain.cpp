#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/key_reference.hpp"
#include "downwash/problems/robot_sources.hpp"

namespace downwash::cli {
namespace {

struct ExplainArguments {
    std::string key;
    std::string kind = "problem";
};

bool ends_with_key(std::string_view path, std::string_view key) {
    return path == key ||
           (path.size() > key.size() && path.ends_with(key) && path[path.size() - key.size() - 1] == '.');
}

/// The same where the unit was left out: "goal.hold" of "goal.hold_s".
bool ends_with_stem(std::string_view path, std::string_view key) {
    return ends_with_key(path.substr(0, path.size() - last_name(path).size() + without_unit(last_name(path)).size()),
                         key);
}

/// The key as in the table: without the indices of list elements.
std::string without_indices(const std::string& key) {
    std::string text;
    bool is_inside = false;
    for (const char letter : key) {
        is_inside = is_inside && letter != ']';
        if (!is_inside) {
            text += letter;
        }
        is_inside = is_inside || letter == '[';
    }
    return text;
}

/// What there is to say of a key below its path.
std::string explanation_of(const KeyReference& key, const std::vector<KeyReference>& all) {
    const ParameterInfo& info = key.info;
    std::string text;
    if (!info.description.empty()) {
        text += "  " + info.description + "\n";
    }
    text += "  expected: " + expectation(info) + "\n";
    if (!key.default_text.empty()) {
        text += (key.default_value ? "  default:  " : "  ") + key.default_text + "\n";
    }
    if (!info.condition.empty()) {
        text += "  applies:  " + info.condition + "\n";
    }
    if (!info.former_name.empty()) {
        text += "  formerly: " + std::string(info.former_name) + "\n";
    }
    std::string below;
    for (const KeyReference& other : all) {
        const std::string_view parent = parent_path(other.info.path);
        if (parent == info.path || parent == info.path + "[]") {
            // One goal and each of a list have the same keys.
            const std::string line = fmt::format("    {:<28} {}\n", last_name(other.info.path), other.info.description);
            below += below.find(line) == std::string::npos ? line : "";
        }
    }
    return text + (below.empty() ? "" : "  keys:\n" + below);
}

/// Whether a word of a text, or some in a row, begin so: "margin" of "safety_margin_m", but not "y_m". Words end at
/// what is no letter and no digit.
bool has_word(std::string_view text, std::string_view beginning) {
    const auto are_equal = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
    for (auto from = text.begin();; ++from) {
        from = std::search(from, text.end(), beginning.begin(), beginning.end(), are_equal);
        if (from == text.end()) {
            return false;
        }
        if (from == text.begin() || std::isalnum(static_cast<unsigned char>(*(from - 1))) == 0) {
            return true;
        }
    }
}

std::string line_of(const KeyReference& known) {
    return fmt::format("  {:<40} {}\n", known.info.path, known.info.description);
}

/// A line for each key in whose path or description a word begins with this one.
std::string keys_about(std::string_view word, const std::vector<KeyReference>& all) {
    std::string text;
    for (const KeyReference& known : all) {
        if (has_word(known.info.path, word) || has_word(known.info.description, word)) {
            text += line_of(known);
        }
    }
    return text;
}

/// A line for each key whose name has the word within it: "pitch_inertia_kg_m2" beside "inertia_kg_m2".
std::string keys_with(std::string_view word, const std::vector<KeyReference>& all) {
    std::string text;
    for (const KeyReference& known : all) {
        const std::string_view name = last_name(known.info.path);
        if (!ends_with_key(name, word) && !ends_with_stem(name, word) && has_word(name, word)) {
            text += line_of(known);
        }
    }
    return text;
}

bool is_of_space(std::string_view kind) {
    return kind.starts_with("space-");
}

/// Says where to ask for a key that only files in space have. @return whether it is one
bool print_if_of_space(const ExplainArguments& given, const std::string& wanted) {
    const std::string kind = "space-" + given.kind;
    if (!file_kind_named(kind)) {
        return false;
    }
    const std::vector<KeyReference>& all = key_reference(*file_kind_named(kind));
    const bool is_there = std::any_of(all.begin(), all.end(), [&](const KeyReference& known) {
        return ends_with_key(known.info.path, wanted) || ends_with_stem(known.info.path, wanted);
    });
    if (is_there) {
        fmt::print("What flies in space has it: downwash explain {} --of {}\n", given.key, kind);
    }
    return is_there;
}

ExitCode run(const ExplainArguments& given) {
    const std::vector<KeyReference>& all = key_reference(*file_kind_named(given.kind));
    const std::string wanted = without_indices(given.key);
    const std::string_view source = robot_source_text(last_name(wanted));
    for (const auto& is_meant : {ends_with_key, ends_with_stem}) {
        std::vector<std::pair<std::string, std::string>> found;  // paths, and what there is to say of all of them
        for (const KeyReference& known : all) {
            if (!is_meant(known.info.path, wanted)) {
                continue;
            }
            const std::string explanation = explanation_of(known, all);
            const auto same = std::find_if(found.begin(), found.end(),
                                           [&](const auto& other) { return other.second == explanation; });
            if (same != found.end()) {
                same->first += known.info.path + "\n";
            } else {
                found.emplace_back(known.info.path + "\n", explanation);
            }
        }
        for (const auto& [paths, explanation] : found) {
            fmt::print("{}{}{}", &paths == &found.front().first ? "" : "\n", paths, explanation);
        }
        if (!found.empty()) {
            if (const std::string others = keys_with(wanted, all); !others.empty()) {
                fmt::print("\nOther keys with this word:\n{}", others);
            }
            if (!source.empty()) {
                fmt::print("\n{}", source);
            }
            return ExitCode::done;
        }
    }
    if (const std::string_view remark = out_of_plane_remark(last_name(wanted));
        !remark.empty() && !is_of_space(given.kind)) {
        fmt::print("No key is called '{}': {}.\n", excerpt(given.key), remark);
        print_if_of_space(given, wanted);
        return ExitCode::done;
    }
    if (!is_of_space(given.kind) && print_if_of_space(given, wanted)) {
        return ExitCode::done;
    }
    if (!source.empty()) {
        fmt::print("{}", source);
        return ExitCode::done;
    }
    if (const std::string about = keys_about(wanted, all); !about.empty() && !wanted.empty()) {
        fmt::print("No key is called '{}'. It occurs in:\n{}", excerpt(given.key), about);
        return ExitCode::done;
    }
    std::vector<std::string_view> names;
    for (const KeyReference& known : all) {
        names.push_back(known.info.path);
        names.push_back(last_name(known.info.path));
    }
    throw UsageError(
        "a {0} file has no key '{1}', and no description has the word{2}; `downwash check --schema {0}` "
        "prints all keys",
        given.kind, excerpt(given.key), did_you_mean(wanted, names));
}

/// Paths and names of the keys of problem files, for shells: without the brackets of lists, which these would read as
/// patterns.
std::set<std::string_view> words_of_keys() {
    std::set<std::string_view> words;
    for (const KeyReference& known : key_reference(FileKind::problem)) {
        if (known.info.path.find('[') == std::string::npos) {
            words.insert({known.info.path, last_name(known.info.path)});
        }
    }
    return words;
}

}  // namespace

void add_explain(Command program, Action& action) {
    auto [command, given] = add_command<ExplainArguments>(
        program, action, "explain", "Explain a key of a file: its meaning, the expected value and the default", run);
    command
        .add_option("KEY", given.key,
                    "a key (safety_margin_m), a path of keys (planner.safety_margin_m), or a word (margin) of keys or "
                    "their descriptions")
        .required()
        .offers(words_of_keys());
    Option option = command.add_option(
        "--of", given.kind,
        "kind of file; default problem, with its robot; what flies in space is of space-problem and space-robot");
    option.one_of({file_kind_names.begin(), file_kind_names.end()});
}

}  // namespace downwash::cli
