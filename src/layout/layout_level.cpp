// SPDX-License-Identifier: MIT
#include "layout/layout_level.h"

#include "core/disjoint_sets.h"

#include <algorithm>
#include <queue>

namespace bot2nurbs {

namespace {

// Short curves make patches narrower down to this part of the usual width...
constexpr double least_width = 0.2;
// ... and their width grows by this much per distance from them.
constexpr double width_slope = 0.7;

} // namespace

LayoutLevel::LayoutLevel(const ManifoldMesh& mesh, std::vector<Index> name, Index name_count,
                         std::vector<double> density, std::vector<Curve> curves)
    : mesh_(&mesh), name_(std::move(name)), density_(std::move(density)),
      curves_(std::move(curves)), offset_(name_count + 1, 0), copies_(name_.size())
{
    for (const Index n : name_)
        ++offset_[n + 1];
    for (Index n = 0; n < name_count; ++n)
        offset_[n + 1] += offset_[n];
    std::vector<Index> at(offset_.begin(), offset_.end() - 1);
    for (Index v = 0; v < name_.size(); ++v)
        copies_[at[name_[v]]++] = v;

    DisjointSets sets(mesh.vertex_count());
    for (const auto& t : mesh.triangles()) {
        sets.join(t[0], t[1]);
        sets.join(t[1], t[2]);
    }
    region_.assign(mesh.vertex_count(), invalid_index);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        Index& of_root = region_[sets.find(v)];
        if (of_root == invalid_index)
            of_root = region_count_++;
        region_[v] = of_root;
    }
}

void LayoutLevel::refine_at_curves(double unit)
{
    std::vector<double> width(density_.size());
    for (std::size_t v = 0; v < width.size(); ++v)
        width[v] = unit / density_[v];
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    const auto limit = [&](Index v, double most) {
        if (most < width[v]) {
            width[v] = most;
            queue.emplace(most, v);
        }
    };
    for (const Curve& curve : curves_) {
        const std::vector<Vec3> point = points(curve);
        double length = 0.0;
        for (std::size_t i = 1; i < point.size(); ++i)
            length += norm(point[i] - point[i - 1]);
        // A closed curve is divided in four at least.
        const double piece = std::max(curve.closed() ? 0.25 * length : length, least_width * unit);
        for (const Index n : curve.vertices)
            for_each_copy(n, [&](Index v) { limit(v, piece); });
    }
    while (!queue.empty()) {
        const auto [w, v] = queue.top();
        queue.pop();
        if (w > width[v])
            continue;
        Index h = mesh_->halfedge_at(v);
        const Index first = h;
        do {
            for (const Index u : {mesh_->to(h), mesh_->from(ManifoldMesh::prev(h))})
                limit(u, w + width_slope * norm(mesh_->position(u) - mesh_->position(v)));
            h = mesh_->twin(ManifoldMesh::prev(h));
        } while (h != first && h != invalid_index);
    }
    for (std::size_t v = 0; v < width.size(); ++v)
        density_[v] = unit / width[v];
}

std::vector<Vec3> LayoutLevel::points(const Curve& curve) const
{
    std::vector<Vec3> result;
    for (const Index n : curve.vertices)
        result.push_back(mesh_->position(any_copy(n)));
    return result;
}

std::vector<double> LayoutLevel::densities(const Curve& curve) const
{
    std::vector<double> result;
    for (const Index n : curve.vertices) {
        result.push_back(0.0);
        for_each_copy(n, [&](Index v) { result.back() = std::max(result.back(), density_[v]); });
    }
    return result;
}

std::vector<Index> LayoutLevel::with_copies(const std::vector<Index>& vertices) const
{
    std::vector<Index> result;
    for (const Index v : vertices)
        for_each_copy(name_[v], [&result](Index copy) { result.push_back(copy); });
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

} // namespace bot2nurbs
