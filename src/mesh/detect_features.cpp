// SPDX-License-Identifier: MIT
#include "bot2nurbs/detect_features.h"

#include "core/disjoint_sets.h"
#include "mesh/boundary_loops.h"
#include "mesh/crease_set.h"
#include "mesh/features.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

// Corners are seen in the directions to points this many edges away along the crease.
constexpr std::size_t corner_reach = 3;
// At the vertex itself a corner turns by this share of its angle, and by this factor more than at
// the vertices beside it: otherwise it is part of an arc in few edges. From so many degrees on it
// is a corner whatever is beside it.
constexpr double corner_share = 0.6;
constexpr double corner_contrast = 1.7;
constexpr double certain_corner = 60.0;
// A connected set of creases is clear when weak edges make up at most this share of its length, its
// sides spread by at most this share of their angle, at most one in three chains (or one in all)
// ends freely, and next to none turn from a ridge to a valley on the way. On the parts and organic
// shapes looked at, the clear share of all creases is above 0.9 or below 0.75: creases of parts are
// sharp, closed and between smooth faces; those of scans and sculpts are ends of ridges that fade.
constexpr double most_weak = 0.25;
constexpr double most_spread = 0.15;
constexpr double most_free_ends = 0.34;
// Of two edges that follow each other along a crease. Parts have none (one in 703 on a fan disk);
// on a sphere with noise, where ridges cannot be told from creases otherwise, it is one in eight.
constexpr double most_sign_changes = 0.05;

// Vertices of a chain where it turns sharply: by `least_angle` seen over a few edges, and most of
// it at the vertex itself, not along an arc.
void find_corners(const ManifoldMesh& mesh, const std::vector<Index>& chain, double least_angle,
                  std::vector<Index>& corners)
{
    const bool closed = chain.front() == chain.back();
    const std::size_t n = chain.size() - 1, first = closed ? 0 : 1;
    const auto at = [&](std::size_t i) { return mesh.position(chain[closed ? i % n : i]); };
    // Angle at point i between the directions to points up to `reach` away.
    const auto turn = [&](std::size_t i, std::size_t reach) {
        const std::size_t back = closed ? reach : std::min(reach, i);
        const std::size_t on = closed ? reach : std::min(reach, n - i);
        return normal_angle_deg(at(i) - at(closed ? i + n - back : i - back), at(i + on) - at(i));
    };
    std::vector<double> here(n + 1, 0.0);
    for (std::size_t i = first; i < n; ++i)
        here[i] = turn(i, 1);
    for (std::size_t i = first; i < n; ++i) {
        const double before = here[i > 0 ? i - 1 : (closed ? n - 1 : 0)];
        const double after = here[closed ? (i + 1) % n : i + 1];
        const bool concentrated =
            here[i] >= certain_corner || (here[i] >= corner_share * least_angle &&
                                          here[i] >= corner_contrast * std::max(before, after));
        if (concentrated && turn(i, std::min(corner_reach, closed ? n / 3 : n)) >= least_angle)
            corners.push_back(chain[i]);
    }
}

// Whether the surface is folded over the edge, not into it.
bool is_ridge(const ManifoldMesh& mesh, Index h)
{
    const Vec3 edge = mesh.position(mesh.to(h)) - mesh.position(mesh.from(h));
    return dot(cross(mesh.area_vector(ManifoldMesh::face(h)),
                     mesh.area_vector(ManifoldMesh::face(mesh.twin(h)))),
               edge) > 0.0;
}

// The share of the length of all chains that is in clear sets of them; 1 without any.
double clear_share(const ManifoldMesh& mesh, const CreaseSet& set, const EdgeAngles& angles,
                   double strong, const std::vector<std::vector<Index>>& chains)
{
    DisjointSets sets(mesh.vertex_count());
    for (const auto& chain : chains)
        for (const Index v : chain)
            sets.join(chain.front(), v);
    struct Network {
        double length = 0.0, weak = 0.0, spread = 0.0;
        int chains = 0, free_ends = 0, pairs = 0, sign_changes = 0;
    };
    std::vector<Network> networks(mesh.vertex_count());
    for (const auto& chain : chains) {
        Network& n = networks[sets.find(chain.front())];
        ++n.chains;
        n.free_ends += set.is_free_end(chain.front()) + set.is_free_end(chain.back());
        bool ridge_before = false;
        for (std::size_t i = 1; i < chain.size(); ++i) {
            Index h = mesh.find_halfedge(chain[i - 1], chain[i]);
            if (h == invalid_index)
                h = mesh.find_halfedge(chain[i], chain[i - 1]);
            const double length = norm(mesh.position(chain[i]) - mesh.position(chain[i - 1]));
            n.length += length;
            n.spread += length * angles.spread[h];
            if (std::min(angles.side[h], angles.face[h]) < strong)
                n.weak += length;
            const bool ridge = is_ridge(mesh, h);
            n.pairs += i > 1;
            n.sign_changes += i > 1 && ridge != ridge_before;
            ridge_before = ridge;
        }
    }
    double clear = 0.0, total = 0.0;
    for (const Network& n : networks) {
        total += n.length;
        if (n.weak <= most_weak * n.length && n.spread <= most_spread * n.length &&
            n.free_ends <= std::max(1.0, most_free_ends * n.chains) &&
            n.sign_changes <= std::max(1.0, most_sign_changes * n.pairs))
            clear += n.length;
    }
    return total > 0.0 ? clear / total : 1.0;
}

} // namespace

std::optional<Error> FeatureOptions::check() const
{
    const auto bad = [](const char* what) {
        return Error{ErrorCode::bad_option, what, invalid_index};
    };
    if (!(angle > 0.0 && angle <= 180.0))
        return bad("the angle of features must be above 0 and at most 180 degrees");
    if (!(weak_share > 0.0 && weak_share <= 1.0))
        return bad("the weak share of features must be above 0 and at most 1");
    if (!(spread_share > 0.0 && spread_share <= 1.0))
        return bad("the spread share of features must be above 0 and at most 1");
    if (!(least_clear_share >= 0.0 && least_clear_share <= 1.0))
        return bad("the least clear share of features must be between 0 and 1");
    if (!(least_length >= 0.0 && std::isfinite(least_length)))
        return bad("the least length of features must not be negative");
    if (!(corner_angle > 0.0 && corner_angle <= 180.0))
        return bad("the angle of corners must be above 0 and at most 180 degrees");
    return std::nullopt;
}

Result<MeshFeatures> detect_features(const ManifoldMesh& mesh, const FeatureOptions& options,
                                     Context& context)
{
    if (const std::optional<Error> failed = options.check())
        return *failed;
    const double weak = options.weak_share * options.angle;
    const EdgeAngles angles = measure_edge_angles(mesh, weak, context);
    if (context.cancelled())
        return Context::cancelled_error("features");
    CreaseSet set(mesh, angles);
    set.grow(options.angle, weak, options.spread_share);
    const double least_length = options.least_length * mesh.box().diagonal();
    set.prune(least_length);
    set.open_slivers();
    set.prune(least_length);

    MeshFeatures result;
    std::vector<std::vector<Index>> creases = set.chains();
    result.clear_share = clear_share(mesh, set, angles, options.angle, creases);
    const bool kept = result.clear_share >= options.least_clear_share;
    if (kept)
        result.creases = std::move(creases);
    for (const auto& chain : result.creases)
        find_corners(mesh, chain, options.corner_angle, result.corners);
    for (std::vector<Index> loop : boundary_loops(mesh)) {
        loop.push_back(loop.front());
        find_corners(mesh, loop, options.corner_angle, result.corners);
    }
    std::sort(result.corners.begin(), result.corners.end());
    result.corners.erase(std::unique(result.corners.begin(), result.corners.end()),
                         result.corners.end());
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
        if (mesh.edge(h) != h)
            continue;
        const bool crease = kept && set.contains(h);
        result.kept_edges += crease;
        if (angles.face[h] >= options.angle) {
            ++result.sharp_edges;
            if (!crease)
                result.smoothed.push_back({mesh.from(h), mesh.to(h)});
        }
    }
    return result;
}

} // namespace bot2nurbs
