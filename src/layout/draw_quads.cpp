// SPDX-License-Identifier: MIT
#include "layout/draw_quads.h"

#include "core/disjoint_sets.h"
#include "layout/region_match.h"
#include "maps/find_route.h"

#include <utility>

namespace bot2nurbs {

namespace {

class Drawing {
public:
    Drawing(const ManifoldMesh& mesh, const QuadComplex& complex,
            const std::vector<Index>& vertices)
        : mesh_(mesh), complex_(complex), vertices_(vertices),
          web_(mesh, vertices), drawn_{complex, web_,
                                       std::vector<Index>(complex.edge_count(), invalid_index)},
          finder_(web_), match_(drawn_), pieces_(complex.vertex_count())
    {
    }

    void add_curve(const DrawnCurve& curve)
    {
        drawn_.path_of[curve.edge] = web_.path_count();
        web_.add_curve(curve.vertices);
        const Index h = complex_.halfedge_of_edge(curve.edge);
        pieces_.join(complex_.from(h), complex_.to(h));
    }

    bool is_drawn(Index edge) const { return drawn_.is_drawn(edge); }

    // Draws an edge, unless no path for it keeps what is left drawable.
    bool draw(Index edge, const std::vector<Index>& straight)
    {
        const Index h = complex_.halfedge_of_edge(edge);
        const Index a = complex_.from(h), b = complex_.to(h);
        const auto route = finder_.find(vertices_[a], sector(h), vertices_[b],
                                        sector(complex_.twin(h)), guide(a, b), straight);
        if (!route)
            return false;
        drawn_.path_of[edge] = web_.path_count();
        web_.add(*route);
        if (pieces_.find(a) != pieces_.find(b)) {
            pieces_.join(a, b);
            return true;
        }
        if (match_.fits(edge))
            return true;
        web_.remove_last();
        drawn_.path_of[edge] = invalid_index;
        return false;
    }

    std::vector<SurfacePath> paths() const
    {
        std::vector<SurfacePath> all = web_.paths(), result;
        for (const Index p : drawn_.path_of)
            result.push_back(std::move(all[p]));
        return result;
    }

private:
    PathWeb::Sector sector(Index h) const
    {
        return web_.sector(vertices_[complex_.from(h)], drawn_.sector_at(h));
    }
    Vec3 normal(Index vertex) const
    {
        Vec3 sum;
        Index h = mesh_.halfedge_at(vertex);
        const Index first = h;
        do {
            sum += mesh_.area_vector(ManifoldMesh::face(h));
            h = mesh_.twin(ManifoldMesh::prev(h));
        } while (h != first && h != invalid_index);
        return normalized(sum);
    }
    GuidePlane guide(Index a, Index b) const
    {
        const Vec3 from = mesh_.position(vertices_[a]), to = mesh_.position(vertices_[b]);
        return {from, normalized(cross(to - from, normal(vertices_[a]) + normal(vertices_[b])))};
    }

    const ManifoldMesh& mesh_;
    const QuadComplex& complex_;
    const std::vector<Index>& vertices_;
    PathWeb web_;
    DrawnEdges drawn_;
    RouteFinder finder_;
    RegionMatch match_;
    DisjointSets pieces_; // Connected pieces of the drawing, as vertices of the complex.
};

// All quads, neighbours soon after each other.
std::vector<Index> breadth_first(const QuadComplex& complex)
{
    std::vector<char> seen(complex.quad_count(), 0);
    std::vector<Index> order;
    for (Index seed = 0; seed < complex.quad_count(); ++seed) {
        if (seen[seed])
            continue;
        seen[seed] = 1;
        order.push_back(seed);
        for (std::size_t i = order.size() - 1; i < order.size(); ++i)
            for (Index h = 4 * order[i]; h < 4 * order[i] + 4; ++h) {
                const Index t = complex.twin(h);
                if (t != invalid_index && !seen[QuadComplex::quad_of(t)]) {
                    seen[QuadComplex::quad_of(t)] = 1;
                    order.push_back(QuadComplex::quad_of(t));
                }
            }
    }
    return order;
}

} // namespace

Result<std::vector<SurfacePath>> draw_quads(const ManifoldMesh& mesh, const QuadComplex& complex,
                                            const std::vector<Index>& vertices,
                                            const std::vector<DrawnCurve>& curves,
                                            const std::vector<std::vector<Index>>& straight,
                                            Context& context)
{
    Drawing drawing(mesh, complex, vertices);
    for (const DrawnCurve& curve : curves)
        drawing.add_curve(curve);
    std::vector<Index> left;
    std::vector<char> listed(complex.edge_count(), 0);
    for (const Index q : breadth_first(complex))
        for (Index h = 4 * q; h < 4 * q + 4; ++h) {
            const Index e = complex.edge(h);
            if (!listed[e] && !drawing.is_drawn(e))
                left.push_back(e);
            listed[e] = 1;
        }
    while (!left.empty()) {
        std::vector<Index> put_off;
        for (const Index e : left) {
            if (context.cancelled())
                return Context::cancelled_error("layout");
            if (!drawing.draw(e, straight[e]))
                put_off.push_back(e);
        }
        if (put_off.size() == left.size())
            return Error{ErrorCode::invalid_domain,
                         "cannot be drawn on the mesh without winding around a handle",
                         left.front()};
        left = std::move(put_off);
    }
    return drawing.paths();
}

} // namespace bot2nurbs
