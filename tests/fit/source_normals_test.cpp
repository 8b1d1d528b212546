// SPDX-License-Identifier: MIT
#include "fit/source_normals.h"

#include "domain_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace bot2nurbs::test {
namespace {

const Vec3 up{0, 0, 1}, down{0, 0, -1};

//! The centres of all cells of a domain, 12 x 12 of a quad.
std::vector<DomainPoint> cell_centres(const QuadComplex& complex)
{
    std::vector<DomainPoint> where;
    for (Index q = 0; q < complex.quad_count(); ++q)
        for (int i = 0; i < 12; ++i)
            for (int j = 0; j < 12; ++j)
                where.push_back({q, (i + 0.5) / 12, (j + 0.5) / 12});
    return where;
}

//! Turned by degrees from `up`.
Vec3 tilted(double degrees)
{
    const double angle = degrees / 57.29577951308232;
    return {2.5 * std::sin(angle), 0.0, 2.5 * std::cos(angle)};
}

TEST(SourceNormals, far_is_a_right_angle_beyond_their_cone)
{
    const fixtures::Domain domain = fixtures::disk_grid(3, 2);
    const std::vector<DomainPoint> where = cell_centres(domain.complex);
    // Alike they are taken for a cone of half angle asin 0.3, 17.5 degrees.
    const SourceNormals alike(domain.complex, std::vector<Vec3>(where.size(), up), where);
    EXPECT_FALSE(alike.far(2, 0.4, 0.7, tilted(107)));
    EXPECT_TRUE(alike.far(2, 0.4, 0.7, tilted(108)));
    // Of a cone of 60 degrees, nothing that is 149 degrees away is.
    std::vector<Vec3> wide;
    std::vector<DomainPoint> twice;
    for (const DomainPoint& w : where)
        for (int k = 0; k < 60; ++k) { // Evenly over the cap: z from 1/2 to 1.
            const double z = 0.5 + 0.5 * (k + 0.5) / 60, turn = 2.399963 * k;
            const double r = std::sqrt(1.0 - z * z);
            wide.push_back({r * std::cos(turn), r * std::sin(turn), z});
            twice.push_back(w);
        }
    const SourceNormals cone(domain.complex, wide, twice);
    EXPECT_FALSE(cone.far(2, 0.4, 0.7, tilted(145)));
    EXPECT_TRUE(cone.far(2, 0.4, 0.7, tilted(155)));
}

TEST(SourceNormals, without_samples_nothing_is_far)
{
    const fixtures::Domain domain = fixtures::disk_grid(3, 2);
    const SourceNormals none(domain.complex, {}, {});
    EXPECT_FALSE(none.far(1, 0.5, 0.5, down));
    // On a piece without any either.
    const SourceNormals one(domain.complex, {up}, {{1, 0.1, 0.1}});
    EXPECT_TRUE(one.far(1, 0.2, 0.2, down));
    EXPECT_FALSE(one.far(1, 0.3, 0.2, down));
}

//! A place of a quad beside one of its sides, a share of the way along it.
DomainPoint beside(Index halfedge, double along, double away)
{
    const Index quad = QuadComplex::quad_of(halfedge);
    switch (QuadComplex::side_of(halfedge)) {
    case 0: return {quad, along, away};
    case 1: return {quad, 1.0 - away, along};
    case 2: return {quad, 1.0 - along, 1.0 - away};
    default: return {quad, away, 1.0 - along};
    }
}

//! Two quads with a common edge, each named from one of its corners.
QuadComplex two_quads(int first, int second, bool crease)
{
    std::array<Index, 4> a{0, 1, 2, 3}, b{1, 4, 5, 2};
    std::rotate(a.begin(), a.begin() + first, a.end());
    std::rotate(b.begin(), b.begin() + second, b.end());
    std::vector<std::pair<Index, Index>> creases;
    if (crease)
        creases.emplace_back(1, 2);
    return *QuadComplex::build(6, {a, b}, creases);
}

TEST(SourceNormals, a_source_that_turns_over_in_a_cell_beside_is_near_but_not_over_a_crease)
{
    constexpr double cell = 1.0 / 12;
    for (int first = 0; first < 4; ++first)
        for (int second = 0; second < 4; ++second)
            for (const bool crease : {false, true}) {
                const QuadComplex complex = two_quads(first, second, crease);
                Index side = 0;
                while (complex.twin(side) == invalid_index)
                    ++side;
                // Up everywhere but in one cell along the edge.
                std::vector<DomainPoint> where = cell_centres(complex);
                std::vector<Vec3> normals(where.size(), up);
                constexpr int turned = 4;
                const DomainPoint place = beside(side, (turned + 0.5) * cell, 0.5 * cell);
                for (std::size_t i = 0; i < where.size(); ++i)
                    if (where[i].quad == place.quad &&
                        std::abs(where[i].u - place.u) < 0.1 * cell &&
                        std::abs(where[i].v - place.v) < 0.1 * cell)
                        normals[i] = down;
                const SourceNormals source(complex, normals, where);
                const auto far = [&](const DomainPoint& d) {
                    return source.far(d.quad, d.u, d.v, down);
                };
                for (int k = 0; k < 12; ++k) {
                    const bool next = std::abs(k - turned) <= 1;
                    const double along = (k + 0.5) * cell;
                    EXPECT_EQ(far(beside(side, along, 0.5 * cell)), !next) << k;
                    EXPECT_EQ(far(beside(side, along, 1.5 * cell)), !next) << k;
                    EXPECT_TRUE(far(beside(side, along, 2.5 * cell))) << k;
                    const Index twin = complex.twin(side);
                    EXPECT_EQ(far(beside(twin, 1.0 - along, 0.5 * cell)), !next || crease) << k;
                    EXPECT_TRUE(far(beside(twin, 1.0 - along, 1.5 * cell))) << k;
                }
            }
}

} // namespace
} // namespace bot2nurbs::test
