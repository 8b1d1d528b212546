// SPDX-License-Identifier: MIT
#pragma once

//! What the tests of readers share: files made of bytes, and errors that say where.

#include "bot2nurbs/result.h"
#include "scratch_file.h"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace bot2nurbs::test {

//! Appends a number as it is in memory, or turned round.
template <class T> void put(std::string& bytes, T value, bool big_endian = false)
{
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (big_endian)
        std::reverse(raw, raw + sizeof(T));
    bytes.append(raw, sizeof(T));
}

//! Expects an error with the code, whose message has the name of the file and all the words.
template <class T> void expect_error_of(const Result<T>& result, const std::string& name,
                                        const std::string& bytes, ErrorCode code,
                                        const std::vector<std::string>& words)
{
    SCOPED_TRACE(name + ": " + bytes.substr(0, 60));
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, code);
    EXPECT_NE(result.error().message.find(name), std::string::npos);
    for (const std::string& word : words)
        EXPECT_NE(result.error().message.find(word), std::string::npos)
            << word << " is not in: " << result.error().message;
}

} // namespace bot2nurbs::test
