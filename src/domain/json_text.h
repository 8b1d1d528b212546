// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/manifold_mesh.h"

#include <string>

namespace bot2nurbs {

//! JSON text written element by element, one element of a large array a line, so that files stay
//! readable by people and by line-based tools.
class JsonText {
public:
    //! `"name": ` after a comma where one is due.
    JsonText& key(const char* name);
    JsonText& open(char bracket);
    JsonText& close(char bracket);
    //! Starts a line for the next element.
    JsonText& line();
    JsonText& value(Index i);
    //! The shortest digits that read back as the same double. \pre finite
    JsonText& value(double x);
    JsonText& value(bool b);
    JsonText& value(const std::string& s);
    //! [face, b0, b1, b2]
    JsonText& value(const SourcePoint& p);

    const std::string& text() const { return text_; }

private:
    void separate();

    std::string text_;
    bool first_ = true; //!< No element yet in the innermost bracket.
    bool line_ = false; //!< A line break is due before the next element.
};

} // namespace bot2nurbs
