// SPDX-License-Identifier: MIT
#include "domain/json_node.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace bot2nurbs {

namespace {

//! Our documents nest at most this deep; nothing is ever read (or fails) below.
constexpr int deepest = 8;
//! How far three stored weights may be from sum 1: a few roundings of numbers up to 1.
constexpr double weight_sum_slack = 1e-12;

//! The JSON pointer of a value, found by its address; only needed for messages.
bool find_pointer(const nlohmann::json& at, const nlohmann::json* wanted, int depth,
                  std::string& pointer)
{
    if (&at == wanted)
        return true;
    if (depth == 0 || !at.is_structured())
        return false;
    const std::size_t length = pointer.size();
    std::size_t i = 0;
    for (auto it = at.begin(); it != at.end(); ++it, ++i) {
        pointer += '/' + (at.is_object() ? it.key() : std::to_string(i));
        if (find_pointer(*it, wanted, depth - 1, pointer))
            return true;
        pointer.resize(length);
    }
    return false;
}

} // namespace

void JsonNode::fail(const std::string& message, ErrorCode code, Index element) const
{
    std::string pointer;
    find_pointer(*root_, value_, deepest, pointer);
    throw JsonFailure{{code, message + " at " + (pointer.empty() ? "/" : pointer), element}};
}

JsonNode JsonNode::at(const char* key) const
{
    if (!value_->is_object())
        fail("expected an object");
    const auto it = value_->find(key);
    if (it == value_->end())
        fail(std::string("missing member \"") + key + '"');
    return JsonNode(root_, &*it);
}

void JsonNode::allow_only(std::initializer_list<const char*> keys) const
{
    if (!value_->is_object())
        fail("expected an object");
    for (auto it = value_->begin(); it != value_->end(); ++it)
        if (std::none_of(keys.begin(), keys.end(),
                         [&](const char* key) { return it.key() == key; }))
            JsonNode(root_, &*it).fail("unknown member");
}

std::size_t JsonNode::size() const
{
    if (!value_->is_array())
        fail("expected an array");
    return value_->size();
}

void JsonNode::expect_size(std::size_t count) const
{
    if (size() != count)
        fail("expected " + std::to_string(count) + " elements, found " + std::to_string(size()));
}

Index JsonNode::index(std::size_t limit, const char* what) const
{
    if (!value_->is_number_unsigned())
        fail(std::string("expected the number of a ") + what);
    const auto value = value_->get<std::uint64_t>();
    if (value >= limit)
        fail(std::string(what) + ' ' + std::to_string(value) + " does not exist (there are " +
             std::to_string(limit) + ')');
    return static_cast<Index>(value);
}

double JsonNode::number() const
{
    if (!value_->is_number())
        fail("expected a number");
    const double value = value_->get<double>();
    if (!std::isfinite(value))
        fail("expected a finite number");
    return value;
}

bool JsonNode::boolean() const
{
    if (!value_->is_boolean())
        fail("expected true or false");
    return value_->get<bool>();
}

std::string JsonNode::text() const
{
    if (!value_->is_string())
        fail("expected a string");
    return value_->get<std::string>();
}

void expect_schema(const JsonNode& root, const std::string& name)
{
    if (!root.is_object())
        root.fail("expected an object with a member \"schema\"", ErrorCode::cannot_read);
    const std::string wanted = name + "/1";
    const JsonNode schema = root.at("schema");
    if (schema.text() != wanted)
        schema.fail("expected \"" + wanted + "\", found \"" + schema.text() + '"',
                    ErrorCode::cannot_read);
}

void expect_signature(const JsonNode& node, const std::string& source_signature)
{
    if (node.text() != source_signature)
        node.fail("made for the mesh with signature " + node.text() +
                      ", but the input's mesh has signature " + source_signature,
                  ErrorCode::stale_domain);
}

SourcePoint read_source_point(const JsonNode& node, const ManifoldMesh& source)
{
    node.expect_size(4);
    SourcePoint point;
    point.face = node.at(std::size_t{0}).index(source.face_count(), "source face");
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        point.bary[k] = node.at(k + 1).number();
        if (point.bary[k] < 0.0)
            node.at(k + 1).fail("expected a barycentric weight that is not negative");
        sum += point.bary[k];
    }
    if (!(std::fabs(sum - 1.0) <= weight_sum_slack))
        node.fail("expected barycentric weights of sum 1");
    return point;
}

Result<nlohmann::json> parse_json(const std::string& text)
{
    try {
        return nlohmann::json::parse(text);
    } catch (const nlohmann::json::parse_error& e) {
        const std::size_t end = std::min(text.size(), e.byte == 0 ? 0 : e.byte - 1);
        const auto line = 1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(end), '\n');
        const std::size_t start = end == 0 ? std::string::npos : text.rfind('\n', end - 1);
        const std::size_t column = start == std::string::npos ? end + 1 : end - start;
        return Error{ErrorCode::cannot_read,
                     "not JSON: unexpected text at line " + std::to_string(line) + ", column " +
                         std::to_string(column),
                     invalid_index};
    } catch (const nlohmann::json::exception&) {
        // The only other failure of parsing: a number no double can hold.
        return Error{ErrorCode::cannot_read, "not JSON: a number is out of range", invalid_index};
    }
}

} // namespace bot2nurbs
