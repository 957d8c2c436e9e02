#pragma once

// Private to problems/.

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash::problems {

using Json = nlohmann::json;

/// A value in the document and the key path that leads to it.
struct Node {
    const Json* json;
    std::string key;

    [[nodiscard]] Node at(std::size_t index) const {
        return {&(*json)[index], key + "[" + std::to_string(index) + "]"};
    }
};

/// Reads values out of a document and collects what is wrong with them.
class JsonReader {
 public:
    /// The greatest size of a coordinate, an angle and their derivatives.
    static constexpr double greatest_number = 1e6;
    /// Further ones are not noted.
    static constexpr std::size_t max_errors = 20;

    void report(const Node& node, const std::string& message) {
        if (errors_.size() < max_errors) {
            errors_.push_back({node.key, message});
        }
    }
    [[nodiscard]] const std::vector<KeyError>& errors() const noexcept { return errors_; }
    /// Notes what is no error, but likely not meant.
    void warn(const Node& node, const std::string& message) {
        if (warnings_.size() < max_errors) {
            warnings_.push_back({node.key, message});
        }
    }
    [[nodiscard]] const std::vector<KeyError>& warnings() const noexcept { return warnings_; }
    [[nodiscard]] bool has_enough() const noexcept { return errors_.size() >= max_errors; }

    /// The member of a group, null included; nothing when it is missing.
    static std::optional<Node> member(const Node& group, std::string_view name) {
        const auto found = group.json->find(name);
        if (found == group.json->end()) {
            return std::nullopt;
        }
        return Node{&*found, group.key.empty() ? std::string(name) : group.key + "." + std::string(name)};
    }

    /// A group that may be missing or null.
    std::optional<Node> optional_group(const Node& root, std::string_view name) {
        auto node = member(root, name);
        if (node && !node->json->is_object()) {
            if (!node->json->is_null()) {
                report(*node, "expected a group of keys or null");
            }
            return std::nullopt;
        }
        return node;
    }

    std::optional<Node> required(const Node& group, std::string_view name) {
        auto node = member(group, name);
        if (!node) {
            report(group, "'" + std::string(name) + "' is missing here");
        }
        return node;
    }

    /// @param max greatest size
    std::optional<double> number(const Node& node, double max = greatest_number) {
        if (!node.json->is_number()) {
            report(node, "expected a number, found " + std::string(node.json->type_name()));
            return std::nullopt;
        }
        const double value = node.json->get<double>();
        if (!(std::abs(value) <= max)) {
            report(node,
                   "expected a number between -" + to_text(max) + " and " + to_text(max) + ", found " + to_text(value));
            return std::nullopt;
        }
        return value;
    }

    /// A figure of a flight, which may be as large as the flight's numbers.
    std::optional<double> figure(const Node& node) { return number(node, max_result); }

    double required_number(const Node& group, std::string_view name) {
        const auto node = required(group, name);
        return node ? number(*node).value_or(0) : 0;
    }

    /// A number from 0 to max_result, `otherwise` when it is missing or null.
    double amount(const Node& group, const char* name, double otherwise) {
        const auto node = member(group, name);
        if (!node || node->json->is_null()) {
            return otherwise;
        }
        const double value = node->json->is_number() ? node->json->get<double>() : -1;
        if (!(value >= 0 && value <= max_result)) {
            report(*node, "expected a number from 0 to " + to_text(max_result));
            return otherwise;
        }
        return value;
    }

    /// The same; nothing when it is missing or null.
    std::optional<double> optional_amount(const Node& group, const char* name) {
        const double value = amount(group, name, -1);
        return value < 0 ? std::nullopt : std::optional(value);
    }

    /// A whole number >= 0 that the type of `value` can hold.
    template <class Integer>
    void read_count(const Node& node, Integer& value) {
        constexpr auto most = static_cast<std::uint64_t>(std::numeric_limits<Integer>::max());
        if (node.json->is_number_unsigned() && node.json->get<std::uint64_t>() <= most) {
            value = node.json->get<Integer>();
        } else {
            report(node, "expected a whole number from 0 to " + std::to_string(most));
        }
    }

    /// Reads a member of a group; `value` is left as it is when that is missing.
    template <class Integer>
    void read_count(const Node& group, const char* name, Integer& value) {
        if (const auto node = member(group, name)) {
            read_count(*node, value);
        }
    }

    void read_flag(const Node& group, const char* name, bool& value) {
        if (const auto node = member(group, name)) {
            if (node->json->is_boolean()) {
                value = node->json->get<bool>();
            } else {
                report(*node, "expected true or false");
            }
        }
    }

    /// One of the values that name_of() knows.
    template <class Enumeration, std::size_t count>
    void read_choice(const Node& group, const char* name, const std::array<Enumeration, count>& values,
                     Enumeration& value) {
        const auto node = member(group, name);
        if (!node) {
            return;
        }
        std::array<std::string_view, count> names;
        for (std::size_t i = 0; i < count; ++i) {
            names[i] = name_of(values[i]);
            if (*node->json == names[i]) {
                value = values[i];
                return;
            }
        }
        report(*node, "expected one of " + joined_names(names));
    }

    /// A list of groups; nothing when it is something else.
    std::vector<Node> groups(const std::optional<Node>& list) {
        std::vector<Node> nodes;
        if (!list) {
            return nodes;
        }
        if (!list->json->is_array()) {
            report(*list, "expected a list, found " + std::string(list->json->type_name()));
            return nodes;
        }
        for (std::size_t i = 0; i < list->json->size(); ++i) {
            nodes.push_back(list->at(i));
            if (!nodes.back().json->is_object()) {
                report(nodes.back(), "expected a group of keys, found " + std::string(nodes.back().json->type_name()));
                nodes.pop_back();
            }
        }
        return nodes;
    }

 private:
    std::vector<KeyError> errors_, warnings_;
};

}  // namespace downwash::problems
