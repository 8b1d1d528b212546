// SPDX-License-Identifier: MIT
#include "layout/trace_faces.h"

#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

// A piece as text: sides of the polygon as digits, chords as letters, upper case when reversed.
std::vector<std::string> pieces(Index corners, const std::vector<Chord>& chords)
{
    std::vector<std::string> result;
    for (const auto& piece : trace_faces(corners, chords)) {
        std::string text;
        for (const TracedSide& s : piece)
            text += static_cast<char>((s.is_chord ? (s.reversed ? 'A' : 'a') : '0') + s.number);
        result.push_back(text);
    }
    return result;
}

using Pieces = std::vector<std::string>;
constexpr Index inside = invalid_index;

TEST(TraceFaces, without_chords_the_polygon_is_one_piece)
{
    EXPECT_EQ(pieces(4, {}), Pieces({"0123"}));
}

TEST(TraceFaces, a_diagonal_has_a_piece_on_either_side)
{
    EXPECT_EQ(pieces(4, {{0, 2}}), Pieces({"01A", "23a"}));
    EXPECT_EQ(pieces(6, {{1, 4}}), Pieces({"0a45", "123A"}));
}

TEST(TraceFaces, a_fan_of_chords_from_one_corner)
{
    EXPECT_EQ(pieces(8, {{0, 3}, {0, 5}}), Pieces({"012A", "34Ba", "567b"}));
}

TEST(TraceFaces, spokes_to_a_point_inside_meet_every_side_once)
{
    EXPECT_EQ(pieces(3, {{0, inside}, {1, inside}, {2, inside}}), Pieces({"0bA", "1cB", "2aC"}));
    EXPECT_EQ(pieces(6, {{1, inside}, {3, inside}, {5, inside}}), Pieces({"0aC5", "12bA", "34cB"}));
}

} // namespace
} // namespace bot2nurbs
