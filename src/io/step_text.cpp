// SPDX-License-Identifier: MIT
#include "io/step_text.h"

#include "io/utf8.h"

#include <array>
#include <charconv>

namespace bot2nurbs {

namespace {

constexpr std::string_view mark_start = "@bot2nurbs:";

bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

//! A string of ISO 10303-21 without its quotes; control characters are left out.
std::string step_string(std::string_view utf8)
{
    constexpr std::string_view digits = "0123456789ABCDEF";
    std::string out;
    while (!utf8.empty()) {
        const std::uint32_t c = next_code_point(utf8);
        if (c == '\'' || c == '\\') {
            out.append(2, static_cast<char>(c));
        } else if (c >= 0x20 && c < 0x7F) {
            out += static_cast<char>(c);
        } else if (c >= 0xA0) {
            const int width = c >= 0x10000 ? 8 : 4;
            out += width == 8 ? "\\X4\\" : "\\X2\\";
            for (int shift = 4 * (width - 1); shift >= 0; shift -= 4)
                out += digits[c >> shift & 0xF];
            out += "\\X0\\";
        }
    }
    return out;
}

//! Length of a real number with decimal point and exponent at the start of the text, or 0.
std::size_t real_length(std::string_view text)
{
    std::size_t i = 0;
    const auto digits = [&] {
        const std::size_t start = i;
        while (i < text.size() && is_digit(text[i]))
            ++i;
        return i > start;
    };
    const auto one_of = [&](std::string_view set) {
        if (i == text.size() || set.find(text[i]) == std::string_view::npos)
            return false;
        ++i;
        return true;
    };
    one_of("-");
    if (!digits() || !one_of("."))
        return 0;
    digits();
    if (!one_of("E"))
        return 0;
    one_of("+-");
    return digits() ? i : 0;
}

//! Writes a real: shortest digits, with the decimal point that STEP wants.
void append_real(std::string_view text, std::string& out)
{
    double value = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    if (value == 0.0)
        value = 0.0; // no negative zero
    std::array<char, 32> buffer{};
    const char* end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    const std::string_view digits(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
    const std::size_t exponent = std::min(digits.find('e'), digits.size());
    const std::string_view mantissa = digits.substr(0, exponent);
    out += mantissa;
    if (mantissa.find('.') == std::string_view::npos)
        out += '.';
    if (exponent < digits.size()) {
        out += 'E';
        out += digits.substr(exponent + 1);
    }
}

//! Number of the name whose mark starts the text, and the mark's length.
bool read_mark(std::string_view text, std::size_t& name, std::size_t& length)
{
    if (text.substr(0, mark_start.size()) != mark_start)
        return false;
    const char* first = text.data() + mark_start.size();
    const auto [end, error] = std::from_chars(first, text.data() + text.size(), name);
    if (error != std::errc{} || end == text.data() + text.size() || *end != '@')
        return false;
    length = static_cast<std::size_t>(end + 1 - text.data());
    return true;
}

} // namespace

std::string step_name_mark(std::size_t i)
{
    return std::string(mark_start) + std::to_string(i) + "@";
}

std::string finish_step_text(std::string_view text, const std::vector<std::string>& names)
{
    std::string out;
    out.reserve(text.size());
    bool in_string = false;
    while (!text.empty()) {
        std::size_t taken = 1, name = 0;
        if (text[0] == '\'') {
            in_string = !in_string;
            out += text[0];
        } else if (in_string && (text[0] == '\n' || text[0] == '\r')) {
            // a string goes on in the next line
        } else if (in_string && read_mark(text, name, taken) && name < names.size()) {
            out += step_string(names[name]);
        } else if (!in_string && (text[0] == '-' || is_digit(text[0]))) {
            taken = real_length(text);
            if (taken > 0) {
                append_real(text.substr(0, taken), out);
            } else { // an integer or an entity's number: all its digits at once
                taken = 1;
                while (taken < text.size() && is_digit(text[taken]))
                    ++taken;
                out += text.substr(0, taken);
            }
        } else {
            taken = 1;
            out += text[0];
        }
        text.remove_prefix(taken);
    }
    return out;
}

} // namespace bot2nurbs
