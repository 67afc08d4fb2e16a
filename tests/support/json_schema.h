// Checks JSON against a JSON Schema (draft 7), as far as this project's schemas need it. An unknown keyword
// is an error, so that a schema cannot state anything unchecked.
#pragma once

#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>

namespace carom::test {

using Json = nlohmann::json;

inline bool has_json_type(const Json& value, const std::string& type) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "null") return value.is_null();
    if (type == "number") return value.is_number();
    if (type == "integer")
        return value.is_number_integer() ||
               (value.is_number_float() && std::floor(value.get<double>()) == value.get<double>());
    throw std::runtime_error("schema: unknown type " + type);
}

class SchemaCheck {
  public:
    explicit SchemaCheck(const Json& schema) : root_(schema) {}

    /// "" or the first fault: its location ("/tracks/0/id") and description.
    std::string fault(const Json& value) const { return fault(root_, value, ""); }

  private:
    std::string fault(const Json& schema, const Json& value, const std::string& at) const {
        static const std::set<std::string> kSaysNothing = {"$schema", "title", "description", "definitions",
                                                           "default"};
        for (const auto& [word, rule] : schema.items()) {
            if (kSaysNothing.count(word) != 0) continue;
            const std::string wrong = fault_of(schema, word, rule, value, at);
            if (!wrong.empty()) return wrong;
        }
        return "";
    }

    std::string fault_of(const Json& schema, const std::string& word, const Json& rule, const Json& value,
                         const std::string& at) const {
        if (word == "$ref")
            return fault(root_.at(Json::json_pointer(rule.get<std::string>().substr(1))), value, at);
        if (word == "type") return type_fault(rule, value, at);
        if (word == "enum") {
            for (const Json& choice : rule)
                if (choice == value) return "";
            return at + ": none of the choices";
        }
        if (word == "const") return rule == value ? "" : at + ": another value";
        if (word == "properties" || word == "required" || word == "additionalProperties" ||
            word == "dependencies")
            return value.is_object() ? object_fault(schema, word, rule, value, at) : "";
        if (word == "items" || word == "minItems" || word == "maxItems")
            return value.is_array() ? array_fault(word, rule, value, at) : "";
        if (word == "minimum" || word == "maximum" || word == "exclusiveMinimum") {
            if (!value.is_number()) return "";
            const double x = value.get<double>(), bound = rule.get<double>();
            const bool good = word == "minimum" ? x >= bound : word == "maximum" ? x <= bound : x > bound;
            return good ? "" : at + ": beyond its " + word;
        }
        if (word == "maxLength") {
            if (!value.is_string()) return "";
            return value.get_ref<const std::string&>().size() <= rule.get<std::size_t>() ? ""
                                                                                         : at + ": too long";
        }
        throw std::runtime_error("schema: unknown word " + word);
    }

    static std::string type_fault(const Json& rule, const Json& value, const std::string& at) {
        if (rule.is_string())
            return has_json_type(value, rule) ? "" : at + ": not of type " + rule.get<std::string>();
        for (const Json& type : rule)
            if (has_json_type(value, type)) return "";
        return at + ": of none of the types";
    }

    std::string object_fault(const Json& schema, const std::string& word, const Json& rule, const Json& value,
                             const std::string& at) const {
        if (word == "required") {
            for (const Json& key : rule)
                if (!value.contains(key.get<std::string>()))
                    return at + ": " + key.get<std::string>() + " is missing";
        } else if (word == "dependencies") {
            for (const auto& [key, others] : rule.items())
                for (const Json& other : others)
                    if (value.contains(key) && !value.contains(other.get<std::string>()))
                        return at + ": " + key + " without " + other.get<std::string>();
        } else if (word == "properties") {
            for (const auto& [key, part] : rule.items()) {
                if (!value.contains(key)) continue;
                const std::string wrong = fault(part, value.at(key), at + "/" + key);
                if (!wrong.empty()) return wrong;
            }
        } else if (rule != false) {
            throw std::runtime_error("schema: additionalProperties has to be false");
        } else {
            for (const auto& [key, part] : value.items())
                if (!schema.at("properties").contains(key)) return at + ": unknown key " + key;
        }
        return "";
    }

    std::string array_fault(const std::string& word, const Json& rule, const Json& value,
                            const std::string& at) const {
        if (word == "minItems") return value.size() >= rule.get<std::size_t>() ? "" : at + ": too few";
        if (word == "maxItems") return value.size() <= rule.get<std::size_t>() ? "" : at + ": too many";
        for (std::size_t i = 0; i < value.size(); ++i) {
            const std::string wrong = fault(rule, value[i], at + "/" + std::to_string(i));
            if (!wrong.empty()) return wrong;
        }
        return "";
    }

    const Json& root_;
};

}  // namespace carom::test
