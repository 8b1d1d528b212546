// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"

#include <string>

namespace bot2nurbs::cli {

//! What the user sees on standard error: a progress bar where that is a terminal, a line a stage
//! where it is not; warnings and errors. Colour only on a terminal and without NO_COLOR.
class Terminal {
public:
    Terminal(bool quiet, bool verbose);

    //! Sends a context's progress and log here.
    void attach(Context& context);
    //! Takes the progress bar away.
    void clear();
    void warning(const std::string& message);
    void error(const std::string& message);
    //! A line that --quiet leaves out.
    void line(const std::string& text);

    bool verbose() const { return verbose_; }

private:
    void show(const std::string& stage, double fraction);
    void tagged(const char* tag, const char* colour, const std::string& message);

    bool quiet_ = false, verbose_ = false, is_terminal_ = false, colour_ = false;
    bool bar_shown_ = false;
    std::string stage_;
    int percent_ = -1;
};

} // namespace bot2nurbs::cli
