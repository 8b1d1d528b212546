// SPDX-License-Identifier: MIT
#include "refine/straighten_domain.h"

#include "bot2nurbs/layout_quality.h"
#include "bot2nurbs/refine_domain.h"
#include "bot2nurbs/validate_domain.h"
#include "domain/domain_paths.h"
#include "hand_domains.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace bot2nurbs {
namespace {

double length(const QuadDomain& domain, Index edge)
{
    const Result<SurfacePath> path = domain_path(domain, edge);
    const ManifoldMesh& mesh = domain.carrier.mesh;
    double sum = 0.0;
    Vec3 last = mesh.position(path->a);
    for (const PathNode& node : path->nodes) {
        const Vec3 next = node.is_vertex() ? mesh.position(node.vertex)
                                           : edge_point(mesh, mesh.edge(node.halfedge), node.t);
        sum += norm(next - last);
        last = next;
    }
    return sum + norm(mesh.position(path->b) - last);
}

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
    const Result<QuadDomain> straight = straighten_domain(cut, context);
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
    const Result<QuadDomain> straight = straighten_domain(cut, context);
    ASSERT_TRUE(straight.ok());
    const LayoutQuality before = measure_layout(cut, *compute_charts(torus.mesh, cut, context));
    const LayoutQuality after =
        measure_layout(*straight, *compute_charts(torus.mesh, *straight, context));
    EXPECT_LT(after.stretch.most, 0.95 * before.stretch.most);
    EXPECT_GT(after.angle.least, before.angle.least);
}

TEST(StraightenDomain, leaves_edges_that_run_along_the_carrier)
{
    const QuadDomain grid = test::torus_grid().domain; // All of its edges do.
    Context context;
    const Result<QuadDomain> straight = straighten_domain(grid, context);
    ASSERT_TRUE(straight.ok());
    for (Index e = 0; e < grid.edges.size(); ++e)
        EXPECT_EQ(length(*straight, e), length(grid, e));
}

TEST(StraightenDomain, is_cancelled)
{
    Context context;
    context.cancel();
    const Result<QuadDomain> straight = straighten_domain(cut_torus(test::torus_askew()), context);
    ASSERT_FALSE(straight.ok());
    EXPECT_EQ(straight.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace bot2nurbs
