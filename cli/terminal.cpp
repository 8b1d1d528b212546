// SPDX-License-Identifier: MIT
#include "terminal.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>

#include <unistd.h>

namespace bot2nurbs::cli {

namespace {

constexpr int bar_width = 24;
constexpr const char* yellow = "\033[33m";
constexpr const char* red = "\033[31m";
constexpr const char* plain = "\033[0m";
constexpr const char* erase_line = "\r\033[K";

} // namespace

Terminal::Terminal(bool quiet, bool verbose)
    : quiet_(quiet), verbose_(verbose), is_terminal_(::isatty(STDERR_FILENO) != 0)
{
    const char* no_color = std::getenv("NO_COLOR");
    colour_ = is_terminal_ && (no_color == nullptr || *no_color == '\0');
}

void Terminal::attach(Context& context)
{
    context.on_progress = [this](const std::string& stage, double fraction) {
        show(stage, fraction);
    };
    context.on_log = [this](LogLevel level, const std::string& message) {
        if (level == LogLevel::warning)
            warning(message);
        else if (verbose_)
            line(message);
    };
}

void Terminal::show(const std::string& stage, double fraction)
{
    if (quiet_)
        return;
    const int percent = static_cast<int>(100.0 * std::clamp(fraction, 0.0, 1.0));
    if (stage == stage_ && (!is_terminal_ || percent == percent_))
        return;
    stage_ = stage;
    percent_ = percent;
    if (!is_terminal_) {
        std::fprintf(stderr, "%s ...\n", stage.c_str());
        return;
    }
    const int full = bar_width * percent / 100;
    std::fprintf(stderr, "%s[%s%s] %3d %% %s", erase_line, std::string(full, '#').c_str(),
                 std::string(bar_width - full, ' ').c_str(), percent, stage.c_str());
    std::fflush(stderr);
    bar_shown_ = true;
}

void Terminal::clear()
{
    if (bar_shown_)
        std::fputs(erase_line, stderr);
    bar_shown_ = false;
    percent_ = -1;
}

void Terminal::tagged(const char* tag, const char* colour, const std::string& message)
{
    clear();
    std::fprintf(stderr, "%s%s:%s %s\n", colour_ ? colour : "", tag, colour_ ? plain : "",
                 message.c_str());
}

void Terminal::warning(const std::string& message)
{
    tagged("warning", yellow, message);
}

void Terminal::error(const std::string& message)
{
    tagged("error", red, message);
}

void Terminal::line(const std::string& text)
{
    if (quiet_)
        return;
    clear();
    std::fprintf(stderr, "%s\n", text.c_str());
}

} // namespace bot2nurbs::cli
