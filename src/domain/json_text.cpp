// SPDX-License-Identifier: MIT
#include "domain/json_text.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace bot2nurbs {

void JsonText::separate()
{
    if (!first_)
        text_ += line_ ? "," : ", ";
    if (line_)
        text_ += '\n';
    first_ = line_ = false;
}

JsonText& JsonText::key(const char* name)
{
    separate();
    text_ += '"';
    text_ += name;
    text_ += "\": ";
    first_ = true; // No comma between a key and its value.
    return *this;
}

JsonText& JsonText::open(char bracket)
{
    separate();
    text_ += bracket;
    first_ = true;
    return *this;
}

JsonText& JsonText::close(char bracket)
{
    if (line_)
        text_ += '\n';
    text_ += bracket;
    first_ = line_ = false;
    return *this;
}

JsonText& JsonText::line()
{
    line_ = true;
    return *this;
}

JsonText& JsonText::value(Index i)
{
    separate();
    text_ += std::to_string(i);
    return *this;
}

JsonText& JsonText::value(double x)
{
    separate();
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, x).ptr;
    text_.append(digits, end);
    if (x == 0.0 && std::signbit(x))
        text_ += ".0"; // Readers take "-0" for the whole number 0.
    return *this;
}

JsonText& JsonText::value(bool b)
{
    separate();
    text_ += b ? "true" : "false";
    return *this;
}

JsonText& JsonText::value(const std::string& s)
{
    separate();
    // Names come from callers: bytes that are no UTF-8 must not throw.
    text_ += nlohmann::json(s).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return *this;
}

JsonText& JsonText::value(const SourcePoint& p)
{
    open('[').value(p.face);
    for (const double w : p.bary)
        value(w);
    return close(']');
}

} // namespace bot2nurbs
