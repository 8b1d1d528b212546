// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/convert.h"

#include <string>
#include <variant>

namespace bot2nurbs::cli {

enum class Action { convert, check, validate_domain };

//! One call of the command.
struct Command {
    Action action = Action::convert;
    ConvertOptions options;
    std::string json;     //!< Where the report goes: a path, "-" for standard output, or nothing.
    unsigned threads = 0; //!< 0: all cores.
    bool quiet = false;
    bool verbose = false;
};

//! Reads the arguments. Prints help, the version, or what is wrong with them; then the value is the
//! exit code.
std::variant<Command, int> parse_command(int argc, char** argv);

} // namespace bot2nurbs::cli
