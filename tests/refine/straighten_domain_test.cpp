// SPDX-License-Identifier: MIT
#include "refine/straighten_domain.h"

#include "bot2nurbs/layout_quality.h"
#include "bot2nurbs/refine_domain.h"
#include "bot2nurbs/validate_domain.h"
#include "hand_domains.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace bot2nurbs {
namespace {

//! A torus with askew edges, one of its quads cut in three and what that takes around it.
QuadDomain cut_torus(const test::HandDomain& torus)
{
    const QuadComplex& complex = torus.domain.complex;
    std::vector<char> marks(complex.edge_count(), 0);
    marks[complex.edge(0)] = marks[complex.edge(1)] = 1;
    marks = close_marks(complex, marks, MarkCosts::of_regularity(complex));
    Context context;
    return std::move(refine_domain(torus.mesh, torus.domain, marks, context)->domain);
}

TEST(StraightenDomain, keeps_topology_and_vertices_and_a_valid_domain)
{
    const test::HandDomain torus = test::torus_askew();
    const QuadDomain cut = cut_torus(torus);
    Context context;
    const Result<QuadDomain> straight = straighten_domain(torus.mesh, cut, context);
    ASSERT_TRUE(straight.ok());
    EXPECT_EQ(straight->complex.quads(), cut.complex.quads());
    EXPECT_EQ(straight->vertices, cut.vertices);
    const Result<DomainValidation> found = validate_domain(torus.mesh, *straight, context);
    ASSERT_TRUE(found.ok());
    EXPECT_TRUE(found->valid()) << found->defects[0].message;
}

TEST(StraightenDomain, makes_the_worst_charts_after_a_cut_better)
{
    const test::HandDomain torus = test::torus_askew();
    const QuadDomain cut = cut_torus(torus);
    Context context;
    const Result<QuadDomain> straight = straighten_domain(torus.mesh, cut, context);
    ASSERT_TRUE(straight.ok());
    const LayoutQuality before = measure_layout(cut, *compute_charts(torus.mesh, cut, context));
    const LayoutQuality after =
        measure_layout(*straight, *compute_charts(torus.mesh, *straight, context));
    EXPECT_LT(after.stretch.most, 0.95 * before.stretch.most);
    EXPECT_GT(after.angle.least, before.angle.least);
}

TEST(StraightenDomain, leaves_edges_that_run_along_the_carrier)
{
    const test::HandDomain torus = test::torus_grid(); // All of its edges do.
    Context context;
    const Result<QuadDomain> straight = straighten_domain(torus.mesh, torus.domain, context);
    ASSERT_TRUE(straight.ok());
    const auto& edges = torus.domain.edges;
    for (Index e = 0; e < edges.size(); ++e) {
        ASSERT_EQ(straight->edges[e].path.size(), edges[e].path.size());
        for (std::size_t i = 0; i < edges[e].path.size(); ++i)
            EXPECT_EQ(straight->edges[e].path[i].from, edges[e].path[i].from);
    }
}

TEST(StraightenDomain, is_cancelled)
{
    const test::HandDomain torus = test::torus_askew();
    Context context;
    context.cancel();
    const Result<QuadDomain> straight = straighten_domain(torus.mesh, cut_torus(torus), context);
    ASSERT_FALSE(straight.ok());
    EXPECT_EQ(straight.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace bot2nurbs
