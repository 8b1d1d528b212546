// SPDX-License-Identifier: MIT
#pragma once

//! Runs the judges: independent readers of the files we write. A judge that is not there fails the
//! test that asks for it.

#include <nlohmann/json.hpp>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace bot2nurbs::judges {

struct Verdict {
    int exit_code = -1;
    nlohmann::json json;
};

//! \pre arguments have no quotes
inline Verdict run(const std::string& command)
{
    Verdict verdict;
    std::FILE* pipe = ::popen(command.c_str(), "r");
    if (pipe == nullptr) {
        ADD_FAILURE() << "cannot run " << command;
        return verdict;
    }
    std::string out;
    std::array<char, 4096> buffer{};
    while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
        out.append(buffer.data(), n);
    const int status = ::pclose(pipe);
    verdict.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    verdict.json = nlohmann::json::parse(out, nullptr, false);
    if (verdict.json.is_discarded()) {
        ADD_FAILURE() << "the judge gave no verdict: " << command << "\n" << out;
        verdict.json = nlohmann::json::object();
    }
    return verdict;
}

//! openNURBS through rhino3dm on Node. Installed by `npm ci` in tests/judges.
inline Verdict judge_3dm(const std::string& file, const std::string& arguments = "")
{
    return run("'" BOT2NURBS_NODE "' '" BOT2NURBS_JUDGES "/judge_3dm.mjs' '" + file + "' " +
               arguments);
}

//! Open CASCADE.
inline Verdict judge_occ(const std::string& file, const std::string& arguments = "")
{
    return run("'" BOT2NURBS_JUDGE_OCC "' '" + file + "' " + arguments);
}

//! A folder that is gone when the test ends.
class ScratchFolder {
public:
    ScratchFolder()
    {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        std::string name = std::string(test->test_suite_name()) + "." + test->name();
        for (char& c : name)
            c = c == '/' ? '_' : c;
        path_ = std::filesystem::temp_directory_path() /
                ("bot2nurbs_" + std::to_string(::getpid()) + "_" + name);
        std::filesystem::create_directories(path_);
    }
    ~ScratchFolder() { std::filesystem::remove_all(path_); }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    std::string file(const std::string& name) const { return (path_ / name).string(); }

private:
    std::filesystem::path path_;
};

} // namespace bot2nurbs::judges
