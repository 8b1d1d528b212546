// SPDX-License-Identifier: MIT
#include "io/atomic_file.h"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace bot2nurbs {
namespace {

namespace fs = std::filesystem;

class WriteWholeFile : public testing::Test {
protected:
    void SetUp() override
    {
        folder_ = fs::temp_directory_path() /
                  ("bot2nurbs_write_" + std::to_string(::getpid()) + "_" +
                   testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::size_t entries() const
    {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    static std::string contents(const std::string& file)
    {
        std::ifstream in(file, std::ios::binary);
        std::ostringstream out;
        out << in.rdbuf();
        return out.str();
    }

    fs::path folder_;
};

void expect_cannot_write(const Status& status, const std::string& reason)
{
    ASSERT_TRUE(status.has_value());
    EXPECT_EQ(status->code, ErrorCode::cannot_write);
    EXPECT_NE(status->message.find(reason), std::string::npos) << status->message;
}

TEST_F(WriteWholeFile, writes_and_replaces_and_leaves_nothing_else)
{
    const std::string bytes("one\0two\n", 8);
    EXPECT_FALSE(write_whole_file(path("a.bin"), bytes));
    EXPECT_EQ(contents(path("a.bin")), bytes);
    EXPECT_FALSE(write_whole_file(path("a.bin"), ""));
    EXPECT_EQ(contents(path("a.bin")), "");
    EXPECT_EQ(entries(), 1u);
}

TEST_F(WriteWholeFile, takes_a_name_without_folder)
{
    const fs::path old = fs::current_path();
    fs::current_path(folder_);
    const Status status = write_whole_file("plain.txt", "x");
    fs::current_path(old);
    EXPECT_FALSE(status);
    EXPECT_EQ(contents(path("plain.txt")), "x");
}

TEST_F(WriteWholeFile, keeps_the_access_rights_of_the_file_it_replaces)
{
    ASSERT_FALSE(write_whole_file(path("a"), "old"));
    ASSERT_EQ(::chmod(path("a").c_str(), 0640), 0);
    ASSERT_FALSE(write_whole_file(path("a"), "new"));
    struct stat s = {};
    ASSERT_EQ(::stat(path("a").c_str(), &s), 0);
    EXPECT_EQ(s.st_mode & 0777, 0640u);
}

TEST_F(WriteWholeFile, follows_a_link_instead_of_replacing_it)
{
    ASSERT_FALSE(write_whole_file(path("target"), "old"));
    fs::create_symlink("target", path("link"));
    ASSERT_FALSE(write_whole_file(path("link"), "new"));
    EXPECT_TRUE(fs::is_symlink(path("link")));
    EXPECT_EQ(contents(path("target")), "new");
}

TEST_F(WriteWholeFile, says_why_it_cannot_write)
{
    expect_cannot_write(write_whole_file("", "x"), "empty");
    expect_cannot_write(write_whole_file(path("missing/a"), "x"), "No such file or directory");
    expect_cannot_write(write_whole_file(folder_.string(), "x"), "Is a directory");
    ASSERT_FALSE(write_whole_file(path("file"), "x"));
    expect_cannot_write(write_whole_file(path("file/a"), "x"), "Not a directory");
    expect_cannot_write(write_whole_file(path(std::string(300, 'n')), "x"), "File name too long");
}

TEST_F(WriteWholeFile, writes_to_a_device_directly)
{
    EXPECT_FALSE(write_whole_file("/dev/null", "x"));
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    expect_cannot_write(write_whole_file("/dev/full", "x"), "No space left");
}

//! The superuser may write everywhere, so where a test runs as one it becomes nobody for a while.
class WithoutPrivileges {
public:
    WithoutPrivileges() : user_(::geteuid())
    {
        if (user_ == 0) {
            EXPECT_EQ(::seteuid(nobody), 0);
        }
    }
    ~WithoutPrivileges()
    {
        if (user_ == 0) {
            EXPECT_EQ(::seteuid(user_), 0);
        }
    }

private:
    static constexpr uid_t nobody = 65534;
    uid_t user_;
};

TEST_F(WriteWholeFile, refuses_a_folder_or_file_that_may_not_be_written)
{
    ASSERT_FALSE(write_whole_file(path("a"), "old"));
    ASSERT_EQ(::chmod(path("a").c_str(), 0444), 0);
    ASSERT_EQ(::chmod(folder_.c_str(), 0777), 0);
    {
        const WithoutPrivileges scope;
        expect_cannot_write(write_whole_file(path("a"), "new"), "Permission denied");
    }
    EXPECT_EQ(contents(path("a")), "old");
    ASSERT_EQ(::chmod(folder_.c_str(), 0555), 0);
    {
        const WithoutPrivileges scope;
        expect_cannot_write(write_whole_file(path("b"), "new"), "Permission denied");
    }
    ASSERT_EQ(::chmod(folder_.c_str(), 0755), 0);
    EXPECT_EQ(entries(), 1u);
}

TEST_F(WriteWholeFile, leaves_the_old_file_and_no_rest_when_space_ends_midway)
{
    ASSERT_FALSE(write_whole_file(path("a"), "old"));
    struct rlimit before = {};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    // A limit on the size of files ends a write midway like a full disk does.
    struct rlimit small = before;
    small.rlim_cur = 4096;
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    const Status status = write_whole_file(path("a"), std::string(100000, 'x'));
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    expect_cannot_write(status, "File too large");
    EXPECT_EQ(contents(path("a")), "old");
    EXPECT_EQ(entries(), 1u);
}

} // namespace
} // namespace bot2nurbs
