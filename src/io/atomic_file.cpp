// SPDX-License-Identifier: MIT
#include "io/atomic_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace bot2nurbs {

namespace {

namespace fs = std::filesystem;

// Tries of temporary names, should files with such names be left behind by crashed processes.
constexpr int name_tries = 100;

Error cannot_write(const std::string& path, const std::string& reason)
{
    return {ErrorCode::cannot_write, "cannot write " + path + ": " + reason, invalid_index};
}

Error cannot_write(const std::string& path, int code)
{
    return cannot_write(path, std::generic_category().message(code));
}

//! Writes all bytes; returns 0 or the errno of what failed.
int write_all(int file, std::string_view bytes)
{
    while (!bytes.empty()) {
        const ssize_t n = ::write(file, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return errno;
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return 0;
}

//! Creates a new file beside the target; returns its descriptor or -1 with errno.
int create_beside(const fs::path& target, mode_t mode, std::string& name)
{
    for (int i = 0; i < name_tries; ++i) {
        const std::string base =
            "." + target.filename().string().substr(0, 200) + ".tmp" + std::to_string(::getpid());
        name = (target.parent_path() / (base + "-" + std::to_string(i))).string();
        const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
        if (file >= 0 || errno != EEXIST)
            return file;
    }
    return -1;
}

//! Makes the new name in a folder durable. Some file systems cannot do this; the file is there.
void sync_folder(const fs::path& target)
{
    const std::string folder = target.has_parent_path() ? target.parent_path().string() : ".";
    const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file >= 0) {
        ::fsync(file);
        ::close(file);
    }
}

Status write_directly(const std::string& path, std::string_view bytes)
{
    const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (file < 0)
        return cannot_write(path, errno);
    int failed = write_all(file, bytes);
    if (::close(file) != 0 && failed == 0)
        failed = errno;
    return failed == 0 ? Status{} : cannot_write(path, failed);
}

} // namespace

Status write_whole_file(const std::string& path, std::string_view bytes)
{
    if (path.empty())
        return cannot_write("a file", "the path is empty");
    fs::path target = path;
    std::error_code error;
    if (fs::is_symlink(target, error)) {
        target = fs::weakly_canonical(target, error);
        if (error)
            return cannot_write(path, error.message());
    }
    struct stat old = {};
    const bool exists = ::stat(target.c_str(), &old) == 0;
    if (exists && S_ISDIR(old.st_mode))
        return cannot_write(path, EISDIR);
    if (exists && !S_ISREG(old.st_mode))
        return write_directly(path, bytes);
    // A rename would replace a file that may not be written to.
    if (exists && ::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0)
        return cannot_write(path, errno);

    std::string temporary;
    const int file = create_beside(target, 0666, temporary);
    if (file < 0)
        return cannot_write(path, errno);
    int failed = 0;
    if (exists && ::fchmod(file, old.st_mode & 07777) != 0)
        failed = errno;
    if (failed == 0)
        failed = write_all(file, bytes);
    if (failed == 0 && ::fsync(file) != 0)
        failed = errno;
    if (::close(file) != 0 && failed == 0)
        failed = errno;
    if (failed == 0 && ::rename(temporary.c_str(), target.c_str()) != 0)
        failed = errno;
    if (failed != 0) {
        ::unlink(temporary.c_str());
        return cannot_write(path, failed);
    }
    sync_folder(target);
    return {};
}

} // namespace bot2nurbs
