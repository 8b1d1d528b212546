// SPDX-License-Identifier: MIT
#include "refine/choose_marks.h"

#include "hand_domains.h"
#include "mesh_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace bot2nurbs {
namespace {

//! A torus of 6 x 4 patches of which one is beyond tolerance.
Trial one_beyond(Index quad, std::array<double, 2> change)
{
    Trial trial;
    trial.domain = test::torus_grid().domain;
    trial.patches.resize(trial.domain.complex.quad_count());
    trial.patches[quad].distance = 1.0;
    trial.patches[quad].exceeds = trial.patches[quad].beyond = true;
    trial.patches[quad].change = change;
    return trial;
}

bool marked(const Trial& trial, const std::vector<char>& marks, Index quad, Index side)
{
    return marks[trial.domain.complex.edge(4 * quad + side)] != 0;
}

TEST(ChooseMarks, distances_that_change_along_one_direction_halve_that_direction_alone)
{
    const Index quad = 7;
    const Trial along_u = one_beyond(quad, {1.0, 0.0}), along_v = one_beyond(quad, {0.0, 1.0});
    const std::vector<char> u = choose_marks(along_u, 1000), v = choose_marks(along_v, 1000);
    for (Index s = 0; s < 4; ++s) {
        EXPECT_EQ(marked(along_u, u, quad, s), s % 2 == 0);
        EXPECT_EQ(marked(along_v, v, quad, s), s % 2 == 1);
    }
}

TEST(ChooseMarks, distances_that_change_in_all_directions_halve_both)
{
    const Index quad = 7;
    const Trial trial = one_beyond(quad, {1.0, 1.0});
    const std::vector<char> marks = choose_marks(trial, 1000);
    for (Index s = 0; s < 4; ++s)
        EXPECT_TRUE(marked(trial, marks, quad, s));
}

TEST(ChooseMarks, a_patch_that_folds_is_cut_once_none_exceeds_the_tolerance)
{
    Trial trial = one_beyond(7, {1.0, 1.0});
    const Index folded = 20; // Away from the other.
    trial.patches[folded].folded = true;
    std::vector<char> marks = choose_marks(trial, 1000);
    EXPECT_TRUE(marked(trial, marks, 7, 0));
    EXPECT_FALSE(marked(trial, marks, folded, 0));
    trial.patches[7] = {};
    marks = choose_marks(trial, 1000);
    EXPECT_FALSE(marked(trial, marks, 7, 0));
    for (Index s = 0; s < 4; ++s)
        EXPECT_TRUE(marked(trial, marks, folded, s));
}

TEST(ChooseMarks, every_quad_gets_an_even_number_of_marks)
{
    const Trial trial = one_beyond(3, {1.0, 1.0});
    const std::vector<char> marks = choose_marks(trial, 1000);
    for (Index q = 0; q < trial.domain.complex.quad_count(); ++q) {
        int sides = 0;
        for (Index s = 0; s < 4; ++s)
            sides += marked(trial, marks, q, s);
        EXPECT_EQ(sides % 2, 0) << "quad " << q;
    }
}

TEST(ChooseMarks, cuts_are_graded)
{
    // On a torus drawn out along x patches at its ends are several times as long as those between.
    QuadDomain domain = test::torus_grid().domain;
    domain.carrier =
        CarrierMesh::from_source(fixtures::moved(domain.carrier.mesh, [](const Vec3& p) {
            return Vec3{std::sinh(3.0 * p.x), p.y, p.z};
        }));
    const QuadComplex& complex = domain.complex;
    const auto length = [&](Index h) {
        const ManifoldMesh& mesh = domain.carrier.mesh;
        return norm(mesh.position(domain.vertices[complex.to(h)]) -
                    mesh.position(domain.vertices[complex.from(h)]));
    };
    int graded = 0;
    for (Index q = 0; q < complex.quad_count(); ++q) {
        Trial trial = one_beyond(q, {1.0, 1.0});
        trial.domain = domain;
        const std::vector<char> marks = choose_marks(trial, 1000);
        for (Index h = 4 * q; h < 4 * q + 4; ++h) {
            // The next edge beyond a cut one, straight on across a vertex of four quads.
            const Index on = complex.next(complex.twin(complex.next(h)));
            const double half = 0.5 * length(h);
            if (length(on) > 3.0 * half) {
                EXPECT_TRUE(marks[complex.edge(on)]) << "quad " << q;
                ++graded;
            }
        }
    }
    EXPECT_GT(graded, 0);
}

TEST(ChooseMarks, patches_far_nearer_than_the_worst_one_are_left)
{
    const std::vector<char> worst = choose_marks(one_beyond(0, {1.0, 1.0}), 1000);
    Trial trial = one_beyond(0, {1.0, 1.0});
    trial.patches[14] = trial.patches[0];
    trial.patches[14].distance = 0.01;
    EXPECT_EQ(choose_marks(trial, 1000), worst);
    trial.patches[14].distance = 0.9;
    const std::vector<char> both = choose_marks(trial, 1000);
    for (Index s = 0; s < 4; ++s)
        EXPECT_TRUE(marked(trial, both, 14, s));
}

TEST(ChooseMarks, a_limit_cuts_the_worst_patches_alone_and_in_the_end_none)
{
    Trial trial = one_beyond(0, {1.0, 1.0});
    const std::vector<char> worst = choose_marks(trial, 1000);
    trial.patches[14] = trial.patches[0];
    trial.patches[14].distance = 0.9;
    const Index quads = trial.domain.complex.quad_count();
    Index limit = quads;
    std::vector<char> marks;
    while (marks.empty() && limit < 1000)
        marks = choose_marks(trial, ++limit);
    EXPECT_EQ(marks, worst); // The first limit that lets any be cut is that of the worst alone.
    EXPECT_TRUE(choose_marks(trial, quads).empty());
}

} // namespace
} // namespace bot2nurbs
