// SPDX-License-Identifier: MIT
#include "layout/place_sites.h"

#include "layout/even_regions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace bot2nurbs {

namespace {

// A closed curve becomes a loop of four edges at least, so that a disk inside can be one quad.
constexpr std::size_t least_closed = 4;

// Names of the sites on curves.
std::vector<Index> sites_on_curves(const LayoutLevel& level, double width)
{
    std::map<std::pair<Index, Index>, int> joining; // Curves between two nodes.
    const auto ends = [](const Curve& c) {
        return std::minmax(c.vertices.front(), c.vertices.back());
    };
    for (const Curve& c : level.curves())
        ++joining[ends(c)];
    std::vector<Index> names;
    for (const Curve& c : level.curves()) {
        if (c.whole) {
            names.push_back(c.vertices.front());
            names.push_back(c.vertices.back());
            continue;
        }
        // Two edges of the domain must not join the same vertices.
        const std::size_t least = c.closed() ? least_closed : joining[ends(c)] > 1 ? 2 : 1;
        for (const std::size_t i :
             divide_polyline(level.points(c), level.densities(c), width, least))
            names.push_back(c.vertices[i]);
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

// Interleaves the bits of three numbers of 21 bits: neighbours in this order are neighbours in
// space.
std::uint64_t morton_code(const Vec3& unit)
{
    const auto spread = [](double x) {
        auto v = static_cast<std::uint64_t>(std::clamp(x, 0.0, 1.0) * 2097151.0);
        v = (v | v << 32) & 0x1f00000000ffff;
        v = (v | v << 16) & 0x1f0000ff0000ff;
        v = (v | v << 8) & 0x100f00f00f00f00f;
        v = (v | v << 4) & 0x10c30c30c30c30c3;
        return (v | v << 2) & 0x1249249249249249;
    };
    return spread(unit.x) | spread(unit.y) << 1 | spread(unit.z) << 2;
}

// Inner vertices along a space-filling curve, one for every equal share of the scaled area; fewer
// where vertices have more than a share.
std::vector<Index> spread_sites(const LayoutLevel& level, Index count)
{
    const ManifoldMesh& mesh = level.mesh();
    std::vector<double> area(mesh.vertex_count(), 0.0);
    for (Index f = 0; f < mesh.face_count(); ++f) {
        const double sixth = norm(mesh.area_vector(f)) / 6.0;
        for (const Index v : mesh.triangle(f))
            area[v] += sixth * level.density()[v] * level.density()[v];
    }
    const Box3 box = mesh.box();
    const Vec3 side = box.max - box.min;
    const double size = std::max({side.x, side.y, side.z});
    std::vector<std::pair<std::uint64_t, Index>> order;
    double total = 0.0;
    for (Index v = 0; v < mesh.vertex_count(); ++v)
        if (!mesh.is_boundary_vertex(v)) {
            order.emplace_back(morton_code((mesh.position(v) - box.min) / size), v);
            total += area[v];
        }
    std::sort(order.begin(), order.end());
    // Of each share the vertex nearest to its centroid.
    std::vector<Index> sites;
    if (count == 0 || !(total > 0.0))
        return sites;
    const double share = total / static_cast<double>(count);
    double begun = 0.0; // Of the next share.
    for (std::size_t begin = 0; begin < order.size();) {
        std::size_t end = begin;
        Vec3 centroid;
        double weight = 0.0;
        do {
            const Index v = order[end++].second;
            centroid += area[v] * mesh.position(v);
            weight += area[v];
        } while (end < order.size() && begun + weight < share);
        begun = std::fmod(begun + weight, share);
        centroid = weight > 0.0 ? centroid / weight : mesh.position(order[begin].second);
        Index nearest = order[begin].second;
        for (std::size_t i = begin; i < end; ++i)
            if (norm_squared(mesh.position(order[i].second) - centroid) <
                norm_squared(mesh.position(nearest) - centroid))
                nearest = order[i].second;
        sites.push_back(nearest);
        begin = end;
    }
    return sites;
}

// For each region without a site its vertex farthest from the middle of the box: which does not
// depend on numbering.
std::vector<Index> first_sites(const LayoutLevel& level, const std::vector<Index>& sites)
{
    const ManifoldMesh& mesh = level.mesh();
    std::vector<char> has_site(level.region_count(), 0);
    for (const Index s : sites)
        has_site[level.regions()[s]] = 1;
    std::vector<Index> farthest(level.region_count(), invalid_index);
    const Vec3 center = mesh.box().center();
    const auto distance = [&](Index v) { return norm_squared(mesh.position(v) - center); };
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        Index& best = farthest[level.regions()[v]];
        if (best == invalid_index || distance(v) > distance(best))
            best = v;
    }
    std::vector<Index> result;
    for (Index r = 0; r < level.region_count(); ++r)
        if (!has_site[r])
            result.push_back(farthest[r]);
    return result;
}

// Vertices that part tiles which must not be neighbours.
std::vector<Index> sites_to_keep_apart(const LayoutLevel& level, const Tiles& tiles)
{
    std::vector<Index> result;
    for (const auto& [a, b] : level.apart)
        level.for_each_copy(a, [&](Index va) {
            level.for_each_copy(b, [&](Index vb) {
                const Index v = tiles.between(va, vb);
                if (v != invalid_index)
                    result.push_back(v);
            });
        });
    return result;
}

} // namespace

Index place_sites(const LayoutLevel& level, const SitePlan& plan, Tiles& tiles,
                  const Context& context)
{
    std::vector<Index> sites;
    for (const Index name : sites_on_curves(level, plan.width))
        level.for_each_copy(name, [&sites](Index v) { sites.push_back(v); });
    std::vector<Index> required;
    for (const Index name : level.required)
        level.for_each_copy(name, [&required](Index v) { required.push_back(v); });
    tiles.fix(required);
    sites.insert(sites.end(), required.begin(), required.end());
    std::sort(sites.begin(), sites.end());
    sites.erase(std::unique(sites.begin(), sites.end()), sites.end());
    const std::size_t given = sites.size();
    Index inner = plan.inner;
    for (const Index s : required)
        if (!level.mesh().is_boundary_vertex(s) && inner > 0)
            --inner;
    if (plan.spread)
        for (const Index v : spread_sites(level, inner))
            if (!std::binary_search(sites.begin(),
                                    sites.begin() + static_cast<std::ptrdiff_t>(given), v))
                sites.push_back(v);
    for (const Index v : first_sites(level, sites))
        sites.push_back(v);
    tiles.grow(sites);
    if (!plan.spread)
        tiles.add_farthest(static_cast<Index>(given) + inner);
    for (int round = 0; round < plan.relaxations && !context.cancelled(); ++round)
        tiles.relax();
    const std::size_t before = tiles.sites().size();
    while (!context.cancelled()) {
        std::vector<Index> missing = tiles.violations();
        if (missing.empty() && plan.keep_apart)
            missing = sites_to_keep_apart(level, tiles);
        if (missing.empty() && plan.even_regions)
            missing = sites_for_even_regions(level, tiles);
        if (missing.empty())
            break;
        tiles.add(level.with_copies(missing));
    }
    return static_cast<Index>(tiles.sites().size() - before);
}

} // namespace bot2nurbs
