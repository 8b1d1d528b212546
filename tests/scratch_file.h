// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>

namespace bot2nurbs::test {

//! A file in the folder for temporary files, removed at the end.
class ScratchFile {
public:
    ScratchFile(const std::string& name, const std::string& bytes)
        : path_(testing::TempDir() + "bot2nurbs_read_" + name)
    {
        std::ofstream(path_, std::ios::binary) << bytes;
    }
    ~ScratchFile() { std::remove(path_.c_str()); }
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;
    const std::string& path() const { return path_; }

private:
    std::string path_;
};

} // namespace bot2nurbs::test
