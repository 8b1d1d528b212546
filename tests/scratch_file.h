// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <unistd.h>

namespace bot2nurbs::test {

//! A file in the folder for temporary files, of this process alone, removed at the end.
class ScratchFile {
public:
    ScratchFile(const std::string& name, const std::string& bytes)
        : path_(testing::TempDir() + "bot2nurbs_" + std::to_string(getpid()) + "_" + name)
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
