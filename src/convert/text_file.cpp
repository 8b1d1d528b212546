// SPDX-License-Identifier: MIT
#include "convert/text_file.h"

#include <fstream>
#include <iterator>

namespace bot2nurbs {

Result<std::string> read_text(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file)
        return Error{ErrorCode::cannot_read, "cannot open " + path, invalid_index};
    std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (file.bad())
        return Error{ErrorCode::cannot_read, "cannot read " + path, invalid_index};
    return text;
}

Error in_file(const std::string& path, Error error)
{
    error.message = path + ": " + error.message;
    return error;
}

} // namespace bot2nurbs
