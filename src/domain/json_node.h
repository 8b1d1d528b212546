// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/manifold_mesh.h"
#include "bot2nurbs/result.h"

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>

namespace bot2nurbs {

//! A value of a JSON document, read with checks. A check that fails throws JsonFailure, which never
//! leaves this folder: read_json() turns it into an Error.
class JsonNode {
public:
    using Json = nlohmann::json;

    explicit JsonNode(const Json& root) : root_(&root), value_(&root) {}

    //! The member of an object. Fails when this is no object or has no such member.
    JsonNode at(const char* key) const;
    bool has(const char* key) const { return value_->is_object() && value_->contains(key); }
    //! Fails when this is no object or has a member of another name: a typing error in a file made
    //! by hand must not pass unseen.
    void allow_only(std::initializer_list<const char*> keys) const;

    //! Number of elements. Fails when this is no array.
    std::size_t size() const;
    JsonNode at(std::size_t i) const { return JsonNode(root_, &(*value_)[i]); }
    //! Fails when this is no array of `count` elements.
    void expect_size(std::size_t count) const;

    bool is_array() const { return value_->is_array(); }
    bool is_object() const { return value_->is_object(); }

    //! A whole number below `limit`; `what` names what is counted ("source face").
    Index index(std::size_t limit, const char* what) const;
    //! A finite number.
    double number() const;
    bool boolean() const;
    std::string text() const;

    //! Throws: "MESSAGE at POINTER".
    [[noreturn]] void fail(const std::string& message, ErrorCode code = ErrorCode::invalid_domain,
                           Index element = invalid_index) const;

private:
    JsonNode(const Json* root, const Json* value) : root_(root), value_(value) {}

    const Json* root_;
    const Json* value_;
};

//! What JsonNode::fail throws.
struct JsonFailure {
    Error error;
};

//! Fails unless the document is an object whose member "schema" is `name`/1.
void expect_schema(const JsonNode& root, const std::string& name);

//! Fails with stale_domain unless the node's text is the signature of `source`.
void expect_signature(const JsonNode& node, const std::string& source_signature);

//! A face and three weights, [face, b0, b1, b2]: weights not negative, sum 1 within rounding.
SourcePoint read_source_point(const JsonNode& node, const ManifoldMesh& source);

//! Parses `text` and returns read(root), a Result<T> or T. Failures of reading and of parsing
//! (cannot_read, with line and column) come back as errors.
template <class T, class Read> Result<T> read_json(const std::string& text, const Read& read);

//! Parses without letting an exception out. The error names line and column.
Result<nlohmann::json> parse_json(const std::string& text);

template <class T, class Read> Result<T> read_json(const std::string& text, const Read& read)
{
    const Result<nlohmann::json> document = parse_json(text);
    if (!document.ok())
        return document.error();
    try {
        return read(JsonNode(*document));
    } catch (const JsonFailure& failure) {
        return failure.error;
    }
}

} // namespace bot2nurbs
