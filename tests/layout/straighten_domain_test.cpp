// SPDX-License-Identifier: MIT
#include "layout/straighten_domain.h"

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

QuadDomain straightened(QuadDomain domain)
{
    Context context;
    EXPECT_FALSE(straighten_domain(domain, 1, context));
    return domain;
}

LayoutQuality quality(const test::HandDomain& torus, const QuadDomain& domain)
{
    Context context;
    return measure_layout(domain, *compute_charts(torus.mesh, domain, context));
}

TEST(StraightenDomain, keeps_a_domain_valid)
{
    const test::HandDomain torus = test::torus_askew();
    const QuadDomain straight = straightened(cut_torus(torus));
    Context context;
    const Result<DomainValidation> found = validate_domain(torus.mesh, straight, context);
    ASSERT_TRUE(found.ok());
    EXPECT_TRUE(found->valid()) << found->defects[0].message;
}

TEST(StraightenDomain, makes_the_worst_charts_after_a_cut_better)
{
    const test::HandDomain torus = test::torus_askew();
    const QuadDomain cut = cut_torus(torus);
    const LayoutQuality before = quality(torus, cut), after = quality(torus, straightened(cut));
    EXPECT_LT(after.stretch.most, 0.95 * before.stretch.most);
    EXPECT_GT(after.angle.least, before.angle.least);
}

TEST(StraightenDomain, leaves_edges_that_run_along_the_carrier)
{
    // One edge of a grid bent aside along carrier edges: a straight line would be shorter.
    test::HandDomain torus = test::torus_grid();
    DomainEdge& edge = torus.domain.edges[0];
    const ManifoldMesh& mesh = torus.mesh;
    const std::size_t middle = edge.path.size() / 2;
    const Index before = edge.path[middle - 1].from, after = edge.path[middle + 1].from;
    // The corner opposite to the edge from the point before the middle one.
    const Index h = mesh.find_halfedge(before, edge.path[middle].from);
    const Index aside = mesh.from(ManifoldMesh::prev(h));
    if (mesh.find_halfedge(aside, after) != invalid_index)
        edge.path[middle] = {aside, aside, 0.0};
    else
        edge.path.insert(edge.path.begin() + static_cast<std::ptrdiff_t>(middle),
                         {aside, aside, 0.0});
    const QuadDomain straight = straightened(torus.domain);
    for (Index e = 0; e < torus.domain.edges.size(); ++e) {
        const auto &was = torus.domain.edges[e].path, &is = straight.edges[e].path;
        ASSERT_EQ(is.size(), was.size()) << e;
        for (std::size_t i = 0; i < was.size(); ++i)
            EXPECT_EQ(is[i].from, was[i].from) << e;
    }
}

TEST(StraightenDomain, is_cancelled_and_leaves_the_domain)
{
    const test::HandDomain torus = test::torus_askew();
    QuadDomain domain = cut_torus(torus);
    const QuadDomain before = domain;
    Context context;
    context.cancel();
    const Status stopped = straighten_domain(domain, 1, context);
    ASSERT_TRUE(stopped);
    EXPECT_EQ(stopped->code, ErrorCode::cancelled);
    for (Index e = 0; e < domain.edges.size(); ++e)
        EXPECT_EQ(domain.edges[e].path.size(), before.edges[e].path.size());
}

} // namespace
} // namespace bot2nurbs
