// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>

namespace bot2nurbs::test {

//! Checks documents against a JSON Schema (draft 2020-12) as far as our schemas go: a keyword it
//! does not know throws, so that none is silently ignored.
class JsonSchema {
public:
    using Json = nlohmann::json;

    explicit JsonSchema(Json schema) : root_(std::move(schema)) {}

    //! A schema of docs/schema by its file name.
    static JsonSchema from_docs(const std::string& name)
    {
        std::ifstream file(std::string(BOT2NURBS_EXAMPLES) + "/../docs/schema/" + name);
        if (!file)
            throw std::runtime_error("no schema " + name);
        return JsonSchema(Json::parse(file));
    }

    //! Empty when the document follows the schema, else what does not and where.
    std::string check(const Json& document) const { return check(document, root_, ""); }

private:
    std::string check(const Json& value, const Json& schema, const std::string& at) const
    {
        static const std::set<std::string> notes{"$schema", "$id", "title", "description", "$defs"};
        for (auto it = schema.begin(); it != schema.end(); ++it) {
            if (notes.count(it.key()))
                continue;
            const std::string fault = check_keyword(value, schema, it.key(), *it, at);
            if (!fault.empty())
                return fault;
        }
        return "";
    }

    std::string check_keyword(const Json& value, const Json& schema, const std::string& keyword,
                              const Json& wanted, const std::string& at) const
    {
        const std::string fault = keyword + " at " + (at.empty() ? "/" : at);
        const auto must = [&](bool holds) { return holds ? std::string() : fault; };
        if (keyword == "$ref")
            return check(value, root_.at(Json::json_pointer(wanted.get<std::string>().substr(1))),
                         at);
        if (keyword == "type") {
            if (!wanted.is_array())
                return must(has_type(value, wanted));
            for (const Json& type : wanted)
                if (has_type(value, type))
                    return "";
            return fault;
        }
        if (keyword == "const")
            return must(value == wanted);
        if (keyword == "enum")
            return must(std::find(wanted.begin(), wanted.end(), value) != wanted.end());
        if (keyword == "oneOf" || keyword == "anyOf") {
            int matches = 0;
            for (const Json& one : wanted)
                matches += check(value, one, at).empty();
            return must(keyword == "oneOf" ? matches == 1 : matches > 0);
        }
        if (keyword == "pattern")
            return must(
                !value.is_string() ||
                std::regex_search(value.get<std::string>(), std::regex(wanted.get<std::string>())));
        if (keyword == "minimum")
            return must(!value.is_number() || value.get<double>() >= wanted.get<double>());
        if (keyword == "maximum")
            return must(!value.is_number() || value.get<double>() <= wanted.get<double>());
        if (keyword == "exclusiveMinimum")
            return must(!value.is_number() || value.get<double>() > wanted.get<double>());
        if (keyword == "exclusiveMaximum")
            return must(!value.is_number() || value.get<double>() < wanted.get<double>());
        if (keyword == "minItems")
            return must(!value.is_array() || value.size() >= wanted.get<std::size_t>());
        if (keyword == "maxItems")
            return must(!value.is_array() || value.size() <= wanted.get<std::size_t>());
        if (keyword == "required") {
            for (const Json& key : wanted)
                if (value.is_object() && !value.contains(key.get<std::string>()))
                    return fault + " (" + key.get<std::string>() + ")";
            return "";
        }
        if (keyword == "properties" || keyword == "additionalProperties")
            return check_members(value, schema, keyword, at);
        if (keyword == "items" || keyword == "prefixItems")
            return check_elements(value, schema, keyword, at);
        throw std::runtime_error("schema keyword " + keyword + " is not known");
    }

    std::string check_members(const Json& value, const Json& schema, const std::string& keyword,
                              const std::string& at) const
    {
        if (!value.is_object())
            return "";
        for (auto it = value.begin(); it != value.end(); ++it) {
            const std::string member = at + "/" + it.key();
            const bool named =
                schema.contains("properties") && schema["properties"].contains(it.key());
            if (named != (keyword == "properties"))
                continue;
            const Json& wanted = named ? schema["properties"][it.key()] : schema[keyword];
            if (wanted.is_boolean()) {
                if (!wanted.get<bool>())
                    return keyword + " at " + member;
                continue;
            }
            const std::string fault = check(*it, wanted, member);
            if (!fault.empty())
                return fault;
        }
        return "";
    }

    std::string check_elements(const Json& value, const Json& schema, const std::string& keyword,
                               const std::string& at) const
    {
        if (!value.is_array())
            return "";
        const std::size_t prefix =
            schema.contains("prefixItems") ? schema["prefixItems"].size() : 0;
        for (std::size_t i = 0; i < value.size(); ++i) {
            if ((i < prefix) != (keyword == "prefixItems"))
                continue;
            const std::string fault =
                check(value[i], i < prefix ? schema[keyword][i] : schema[keyword],
                      at + "/" + std::to_string(i));
            if (!fault.empty())
                return fault;
        }
        return "";
    }

    static bool has_type(const Json& value, const Json& type)
    {
        if (type == "object")
            return value.is_object();
        if (type == "array")
            return value.is_array();
        if (type == "string")
            return value.is_string();
        if (type == "boolean")
            return value.is_boolean();
        if (type == "null")
            return value.is_null();
        if (type == "integer")
            return value.is_number_integer();
        if (type == "number")
            return value.is_number();
        throw std::runtime_error("schema type " + type.dump() + " is not known");
    }

    Json root_;
};

} // namespace bot2nurbs::test
