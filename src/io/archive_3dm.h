// SPDX-License-Identifier: MIT
#pragma once

//! The container of openNURBS archives (.3dm): little-endian values in nested chunks with CRCs.
//! docs/formats/3dm.md tells what is written with it.

#include "bot2nurbs/vec.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace bot2nurbs {

//! A 128-bit id as sixteen bytes in the order they are written.
using Uuid = std::array<std::uint8_t, 16>;

//! An id from its text form "60B5DBC5-E660-11D3-BFE4-0010830122F0": the first three groups are
//! stored with their bytes reversed.
Uuid uuid_from_text(const char* text);

//! CRC-32 (polynomial of zlib) of bytes that follow others with CRC `crc`; 0 to start.
std::uint32_t crc32(std::uint32_t crc, const void* bytes, std::size_t count);

//! Builds an archive in memory. Chunks are opened and closed like brackets; lengths and CRCs are
//! filled in when a chunk is closed.
class ArchiveWriter {
public:
    //! `version` decides the width of lengths: 4 bytes below 50, else 8.
    explicit ArchiveWriter(int version) : version_(version) {}
    int version() const { return version_; }

    void byte(int value);
    void int16(int value);
    void int32(std::int64_t value); //!< Also unsigned values up to 2^32 - 1.
    void real(double value);
    void reals(const std::vector<double>& values);
    void point(const Vec3& p);
    void point(const Vec2& p);
    void interval(double a, double b);
    //! Lower and upper corner; an empty box is written as zeros.
    void box(const Box3& b);
    void uuid(const Uuid& id);
    void zeros(int count);
    //! Count of UTF-16 units with the closing zero, then the units; 0 alone when empty. Bytes that
    //! are not UTF-8 become U+FFFD.
    void wide_string(std::string_view utf8);
    //! Count, then the numbers.
    template <class List> void index_list(const List& list)
    {
        int32(static_cast<std::int64_t>(list.size()));
        for (auto i : list)
            int32(i);
    }
    void text(std::string_view bytes);

    //! A chunk whose value is the data.
    void short_chunk(std::uint32_t typecode, std::int64_t value);
    void begin(std::uint32_t typecode);
    void end();

    const std::string& bytes() const { return bytes_; }
    std::string take() { return std::move(bytes_); }

private:
    struct Open {
        std::uint32_t typecode;
        std::size_t length_at; //!< Where the length field is.
        std::size_t plain_at;  //!< First own byte not yet in the CRC.
        std::uint32_t crc;
    };
    void put(const void* data, std::size_t count);
    void header(std::uint32_t typecode, std::int64_t value);
    void absorb(); //!< Takes the own bytes of the innermost open chunk so far into its CRC.
    void resume(); //!< Own bytes of the innermost open chunk go on here.

    int version_;
    std::string bytes_;
    std::vector<Open> open_;
};

} // namespace bot2nurbs
