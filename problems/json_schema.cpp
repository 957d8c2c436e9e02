#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "downwash/problems/key_reference.hpp"

// https://json-schema.org/draft-07: the version that editors of YAML know best.

namespace downwash {
namespace {

using Json = nlohmann::ordered_json;

Json any_of(std::vector<Json> schemas) {
    return schemas.size() == 1 ? schemas.front() : Json{{"anyOf", std::move(schemas)}};
}

Json number_schema(const ParameterInfo& info, const char* type) {
    Json schema{{"type", type}};
    if (info.range.low) {
        schema[info.range.excludes_low ? "exclusiveMinimum" : "minimum"] = *info.range.low;
    }
    if (info.range.high) {
        schema[info.range.excludes_high ? "exclusiveMaximum" : "maximum"] = *info.range.high;
    }
    return schema;
}

Json array_schema(Json items, std::size_t count = 0) {
    Json schema{{"type", "array"}, {"items", std::move(items)}};
    if (count > 0) {
        schema["minItems"] = count;
        schema["maxItems"] = count;
    }
    return schema;
}

Json json_of(const Value& value) {
    return std::visit(
        [](const auto& held) -> Json {
            if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::monostate>) {
                return nullptr;
            } else if constexpr (std::is_same_v<std::decay_t<decltype(held)>, Spread>) {
                switch (held.form) {
                    case Spread::Form::sd:
                        return held.low != 0 ? Json{{"mean", held.low}, {"sd", held.high}} : Json{{"sd", held.high}};
                    case Spread::Form::range:
                        return {{"range", {held.low, held.high}}};
                    case Spread::Form::factor:
                        return {{"factor", {held.low, held.high}}};
                    case Spread::Form::exact:
                        break;
                }
                return 0;
            } else {
                return held;
            }
        },
        value);
}

/// Units, ranges and defaults too: of all that a schema says editors show people this alone.
std::string description_of(const KeyReference& key) {
    const ParameterInfo& info = key.info;
    std::string text = info.description;
    if (!info.condition.empty()) {
        text += " (" + info.condition + ")";
    }
    if (info.kind != ParameterKind::group && info.kind != ParameterKind::list) {
        text += (text.empty() ? "" : "\n") + expectation(info);
        text += key.default_value ? "; default " + key.default_text : "";
    }
    return text;
}

class SchemaWriter {
 public:
    explicit SchemaWriter(const std::vector<KeyReference>& keys) {
        for (const KeyReference& key : keys) {
            children_[std::string(parent_path(key.info.path))].push_back(&key);
        }
    }

    /// The schema of a group of keys.
    [[nodiscard]] Json object(const std::string& path) const {
        Json properties = Json::object(), required = Json::array();
        std::vector<Json> alternatives;
        for (const KeyReference* key : children(path)) {
            const std::string name(last_name(key->info.path));
            properties[name] = property(*key);
            if (key->info.required && key->info.condition.empty()) {
                required.push_back(name);
            } else if (key->info.exclusive) {
                alternatives.push_back({{"required", {name}}});
            }
        }
        Json schema{{"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties)}};
        if (!required.empty()) {
            schema["required"] = std::move(required);
        }
        if (!alternatives.empty()) {
            schema["oneOf"] = std::move(alternatives);
        }
        return schema;
    }

 private:
    [[nodiscard]] const std::vector<const KeyReference*>& children(const std::string& path) const {
        static const std::vector<const KeyReference*> none;
        const auto found = children_.find(path);
        return found == children_.end() ? none : found->second;
    }

    [[nodiscard]] Json property(const KeyReference& key) const {
        const ParameterInfo& info = key.info;
        std::vector<Json> forms{form(info)};
        if (info.can_be_none) {
            forms.push_back({{"const", "none"}});
        }
        if (info.can_be_file) {
            forms.push_back({{"type", "string"}});
        }
        if (info.can_be_list) {
            forms.push_back(array_schema(object(info.path + "[]")));
        }
        if (info.can_be_group) {
            forms.push_back(object(info.path));
        }
        if (info.can_be_integers) {
            forms.push_back(array_schema({{"type", "integer"}, {"minimum", 0}}));
        }
        if (info.can_be_single) {
            forms.push_back(number_schema(info, "number"));
        }
        if (info.can_be_matrix) {
            forms.push_back(array_schema(array_schema(Json{{"type", "number"}}, 3), 3));
        }
        if (info.nullable) {
            forms.push_back({{"type", "null"}});
        }
        Json schema = any_of(std::move(forms));
        if (const std::string description = description_of(key); !description.empty()) {
            schema["description"] = description;
        }
        if (key.default_value && info.default_of.empty()) {
            schema["default"] = json_of(*key.default_value);
        }
        return schema;
    }

    [[nodiscard]] static Json spread_schema(const ParameterInfo& info) {
        std::vector<Json> forms{{{"const", 0}}};
        for (const std::string_view name : info.elements) {
            const Json number{{"type", "number"}};
            const Json value = name == "sd" ? Json{{"type", "number"}, {"minimum", 0}} : array_schema(number, 2);
            Json properties{{std::string(name), value}};
            if (name == "sd" && std::ranges::find(info.elements, "range") != info.elements.end()) {
                properties["mean"] = number;
            }
            forms.push_back({{"type", "object"},
                             {"additionalProperties", false},
                             {"properties", std::move(properties)},
                             {"required", {name}}});
        }
        return any_of(std::move(forms));
    }

    [[nodiscard]] Json form(const ParameterInfo& info) const {
        switch (info.kind) {
            case ParameterKind::group:
                return object(info.path);
            case ParameterKind::list:
                return array_schema(object(info.path + "[]"));
            case ParameterKind::number:
                return number_schema(info, "number");
            case ParameterKind::integer:
                return number_schema(info, "integer");
            case ParameterKind::flag:
                return {{"type", "boolean"}};
            case ParameterKind::text:
            case ParameterKind::file:
                return {{"type", "string"}};
            case ParameterKind::identifier:
                return {{"type", "string"}, {"pattern", "^[A-Za-z0-9_-]{1,64}$"}};
            case ParameterKind::choice:
                return {{"enum", info.names}};
            case ParameterKind::numbers:
                return info.elements.empty() ? array_schema(number_schema(info, "number"))
                                             : array_schema(number_schema(info, "number"), info.elements.size());
            case ParameterKind::points:
                return array_schema(array_schema(number_schema(info, "number"), 3));
            case ParameterKind::samples:
                return array_schema(number_schema(info, "number"));
            case ParameterKind::choices:
                return array_schema({{"enum", info.names}});
            case ParameterKind::files:
                return array_schema({{"type", "string"}});
            case ParameterKind::spread:
                return spread_schema(info);
        }
        return Json::object();
    }

    std::map<std::string, std::vector<const KeyReference*>> children_;
};

const char* title_of(FileKind kind) {
    switch (kind) {
        case FileKind::robot:
            return "A robot of Downwash";
        case FileKind::campaign:
            return "A campaign of Downwash";
        case FileKind::space_problem:
            return "A problem of Downwash in space";
        case FileKind::space_robot:
            return "A robot of Downwash in space";
        case FileKind::problem:
            break;
    }
    return "A problem of Downwash";
}

}  // namespace

std::string json_schema(FileKind kind) {
    Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title_of(kind)}};
    schema.update(SchemaWriter(key_reference(kind)).object(""));
    constexpr int indent = 2;
    return schema.dump(indent) + "\n";
}

}  // namespace downwash
