#include "downwash/results/solution_document.hpp"

#include <fstream>
#include <string_view>

#include "downwash/problems/problem_reader.hpp"
#include "downwash/results/json_place.hpp"
#include "downwash/results/solution_file.hpp"

namespace downwash::problems {
namespace {

constexpr int deepest_value = 32;

[[noreturn]] void throw_at(const std::string& path, TextPlace place, const std::string& message) {
    throw ProblemFileError({{path, place.line, place.column, message}});
}

/// Without the byte order mark that some editors put before UTF-8.
std::string read_text(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    std::string text;
    // A folder opens like a file and fails at the first byte.
    if (!stream || (stream.peek(), stream.bad())) {
        throw_at(path, {}, "cannot be read; expected a solution.json that `solve` wrote");
    }
    char block[65536];
    while (stream.read(block, sizeof block), stream.gcount() > 0) {
        text.append(block, static_cast<std::size_t>(stream.gcount()));
        if (text.size() > max_solution_bytes) {
            throw_at(path, {},
                     "is larger than " + std::to_string(max_solution_bytes >> 20U) +
                         " MiB, more than any plan of `solve` takes: expected its solution.json");
        }
    }
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) {
        text.erase(0, byte_order_mark.size());
    }
    return text;
}

Json parse(const std::string& path, const std::string& text) {
    bool is_deep = false;
    try {
        Json document = Json::parse(text, [&is_deep](int depth, Json::parse_event_t, Json&) {
            is_deep = is_deep || depth > deepest_value;
            return !is_deep;
        });
        if (!is_deep) {
            return document;
        }
    } catch (const Json::parse_error& error) {
        if (!is_deep) {
            throw_at(path, place_of_byte(text, error.byte > 0 ? error.byte - 1 : 0),
                     text.empty() ? "the file is empty" : "this is not JSON, or the file was cut off here");
        }
    } catch (const Json::exception&) {
        if (!is_deep) {
            throw_at(path, {}, "holds a number that is too large");
        }
    }
    throw_at(path, {}, "nests deeper than the file of a plan does");
}

/// What was found at a key, with its place in the file.
LocatedError located(const std::string& path, const std::string& text, const KeyError& found) {
    const auto place = json_place(text, found.key);
    return {path, place.line, place.column, found.key.empty() ? found.message : found.key + ": " + found.message};
}

}  // namespace

void read_document(const std::string& path, const std::function<void(JsonReader&, const Node&)>& read,
                   const std::function<void(const LocatedError&)>& on_warning) {
    const std::string text = read_text(path);
    const Json document = parse(path, text);
    const Node root{&document, ""};
    JsonReader reader;
    if (!document.is_object()) {
        reader.report(root, "expected a group of keys as `solve` writes it");
    } else if (const auto schema = reader.required(root, "schema"); schema && *schema->json != solution_schema) {
        reader.report(*schema, "unsupported schema; expected " + std::string(solution_schema));
    } else if (schema) {
        read(reader, root);
    }
    if (!reader.errors().empty()) {
        std::vector<LocatedError> errors;
        for (const KeyError& error : reader.errors()) {
            errors.push_back(located(path, text, error));
        }
        throw ProblemFileError(std::move(errors));
    }
    if (on_warning) {
        for (const KeyError& warning : reader.warnings()) {
            on_warning(located(path, text, warning));
        }
    }
}

void read_objective(JsonReader& reader, const Node& root, CostFunction& objective) {
    const auto node = JsonReader::member(root, "objective");
    if (!node || !node->json->is_object()) {
        Objective single{};
        reader.read_choice(root, "objective", all_objectives, single);
        objective = node ? CostFunction(single) : objective;
        return;
    }
    objective = CostFunction::of_nothing();
    for (const Objective each : all_objectives) {
        objective.weight(each) = reader.amount(*node, name_of(each).data(), 0);
    }
    if (objective == CostFunction::of_nothing()) {
        reader.report(*node, "expected a weight above 0");
    }
}

}  // namespace downwash::problems
