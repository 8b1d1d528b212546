// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <cstdint>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace bot2nurbs {

//! Words and numbers of a text in memory, with the line they stand on. Lines end with LF, CR LF or
//! CR. Numbers do not depend on the locale and are the nearest double.
class TextScanner {
public:
    //! `comment` starts a comment to the end of the line; 0 for none.
    TextScanner(std::string_view text, char comment)
        : p_(text.data()), end_(text.data() + text.size()), comment_(comment)
    {
    }

    //! Line of the word read last, from 1.
    std::size_t line() const { return line_; }
    std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - p_); }
    const char* position() const { return p_; }

    //! Skips blanks and comments of this line; true when nothing is left on it.
    bool at_line_end()
    {
        while (p_ != end_ && is_blank(*p_))
            ++p_;
        if (p_ != end_ && comment_ != 0 && *p_ == comment_)
            while (p_ != end_ && !is_newline(*p_))
                ++p_;
        return p_ == end_ || is_newline(*p_);
    }
    //! Skips blanks, comments and ends of lines; true when nothing is left.
    bool at_end()
    {
        while (at_line_end()) {
            if (p_ == end_)
                return true;
            skip_newline();
        }
        return false;
    }
    //! Goes to the start of the next line.
    void skip_line()
    {
        while (p_ != end_ && !is_newline(*p_))
            ++p_;
        if (p_ != end_)
            skip_newline();
    }
    //! The rest of the line without blanks around it.
    std::string_view rest_of_line()
    {
        while (p_ != end_ && is_blank(*p_))
            ++p_;
        const char* start = p_;
        while (p_ != end_ && !is_newline(*p_))
            ++p_;
        const char* stop = p_;
        while (stop != start && is_blank(stop[-1]))
            --stop;
        return {start, static_cast<std::size_t>(stop - start)};
    }
    //! The next word of this line; empty at its end.
    std::string_view word_in_line()
    {
        if (at_line_end())
            return {};
        const char* start = p_;
        while (p_ != end_ && !is_blank(*p_) && !is_newline(*p_))
            ++p_;
        return {start, static_cast<std::size_t>(p_ - start)};
    }
    //! The next word; empty at the end of the text.
    std::string_view word() { return at_end() ? std::string_view() : word_in_line(); }

    //! Reads the next word as a number. False, with the word in `bad_word()`, when it is none.
    template <class T> bool number(T& value)
    {
        if (at_end()) {
            bad_word_ = {};
            return false;
        }
        return number_here(value);
    }
    //! As number, on this line only.
    template <class T> bool number_in_line(T& value)
    {
        if (at_line_end()) {
            bad_word_ = {};
            return false;
        }
        return number_here(value);
    }
    //! The word that was no number; empty when there was none.
    std::string_view bad_word() const { return bad_word_; }

private:
    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
    static bool is_newline(char c) { return c == '\n' || c == '\r'; }
    void skip_newline()
    {
        if (*p_ == '\r' && p_ + 1 != end_ && p_[1] == '\n')
            ++p_;
        ++p_;
        ++line_;
    }
    template <class T> bool number_here(T& value)
    {
        const char* start = p_;
        if (*p_ == '+' && p_ + 1 != end_ && p_[1] != '-')
            ++p_;
        const auto [after, error] = std::from_chars(p_, end_, value);
        const bool ends =
            after == end_ || is_blank(*after) || is_newline(*after) || *after == comment_;
        if (error == std::errc() && ends) {
            p_ = after;
            return true;
        }
        p_ = start;
        bad_word_ = word_in_line();
        // Too small for a double is zero; too large stays an error.
        if constexpr (std::is_floating_point_v<T>)
            if (error == std::errc::result_out_of_range && ends && underflows(bad_word_)) {
                value = T(0);
                return true;
            }
        return false;
    }
    static bool underflows(std::string_view word)
    {
        const std::size_t e = word.find_first_of("eE");
        return (e != std::string_view::npos && e + 1 < word.size() && word[e + 1] == '-') ||
               word.substr(0, 4).find("0.0") != std::string_view::npos;
    }

    const char* p_;
    const char* end_;
    char comment_;
    std::size_t line_ = 1;
    std::string_view bad_word_;
};

} // namespace bot2nurbs
