// SPDX-License-Identifier: MIT
#include "io/file_bytes.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <sys/stat.h>

namespace bot2nurbs {

namespace {

constexpr std::size_t read_block = std::size_t{1} << 22; // 4 MiB: some 1 ms between polls

} // namespace

Result<std::string> read_bytes(const std::string& path, Context& context)
{
    const auto fail = [&path](const std::string& why) {
        return Error{ErrorCode::cannot_read, "cannot read " + path + ": " + why, invalid_index};
    };
    struct stat info {};
    if (stat(path.c_str(), &info) != 0)
        return fail(std::strerror(errno));
    if (S_ISDIR(info.st_mode))
        return fail("it is a folder");
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                               std::fclose);
    if (!file)
        return fail(std::strerror(errno));
    std::string bytes;
    if (info.st_size > 0)
        bytes.reserve(static_cast<std::size_t>(info.st_size) + 1);
    for (;;) {
        if (context.cancelled())
            return Context::cancelled_error("read");
        const std::size_t old = bytes.size();
        // Asking for one byte more than the size shows the end in the same call.
        const std::size_t want =
            bytes.capacity() > old ? std::min(bytes.capacity() - old, read_block) : read_block;
        bytes.resize(old + want);
        const std::size_t got = std::fread(&bytes[old], 1, want, file.get());
        bytes.resize(old + got);
        if (got < want)
            break;
    }
    if (std::ferror(file.get()))
        return fail("input error");
    if (bytes.empty())
        return Error{ErrorCode::cannot_read, path + ": the file is empty", invalid_index};
    return bytes;
}

std::string extension(const std::string& path)
{
    const std::size_t slash = path.find_last_of('/');
    const std::size_t dot = path.find_last_of('.');
    if (dot == std::string::npos || (slash != std::string::npos && dot < slash))
        return {};
    std::string text = path.substr(dot + 1);
    for (char& c : text)
        if (c >= 'A' && c <= 'Z')
            c = static_cast<char>(c - 'A' + 'a');
    return text;
}

} // namespace bot2nurbs
