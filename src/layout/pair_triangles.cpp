// SPDX-License-Identifier: MIT
#include "layout/pair_triangles.h"

#include "core/parallel.h"
#include "layout/curves.h"
#include "layout/face_energy.h"
#include "layout/pairing.h"
#include "layout/valences.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bot2nurbs {

namespace {

// What an edge less at a vertex is worth against distortion, per edge the vertex has too many.
constexpr double valence_weight = 0.35;
// Total cost is lowered among pairings whose worst distortion is within this factor of the optimum.
constexpr double bottleneck_slack = 1.3;
// Rounds of splitting triangles that are in the way of a pairing.
constexpr int max_split_rounds = 8;

struct Candidates {
    std::vector<PairCandidate> pairs;
    std::vector<Index> path; // Of each pair: the path that joining drops.
};

// All pairs that can be mapped to the square. Empty when cancelled.
std::optional<Candidates> find_candidates(const PatchComplex& complex, Context& context)
{
    const double infinity = std::numeric_limits<double>::infinity();
    std::vector<double> distortion(complex.paths().size(), infinity);
    oneapi::tbb::enumerable_thread_specific<OverlayBuilder> builders(
        [&complex] { return OverlayBuilder(complex.mesh()); });
    const bool finished =
        for_each_chunk(context, distortion.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (Index p = static_cast<Index>(begin); p < end; ++p) {
                const PatchComplex::Path& path = complex.paths()[p];
                if (!path.alive || complex.is_fixed(p))
                    continue;
                const auto border = complex.border({path.left, path.right});
                if (border && border->size() == 4)
                    distortion[p] = face_distortion(complex.geometry(*border), builders.local());
            }
        });
    if (!finished)
        return std::nullopt;
    const Valences valences(complex, 3);
    Candidates result;
    for (Index p = 0; p < complex.paths().size(); ++p) {
        if (!std::isfinite(distortion[p]))
            continue;
        const PatchComplex::Path& path = complex.paths()[p];
        PairCandidate c;
        c.face_a = path.left;
        c.face_b = path.right;
        c.distortion = distortion[p];
        // A vertex that has as many edges as wanted of triangles and loses a third has as many as
        // wanted of quads; what joining across an edge does to a vertex is counted from there.
        c.cost = c.distortion - valence_weight * (valences.excess(path.geometry.a) +
                                                  valences.excess(path.geometry.b));
        result.pairs.push_back(c);
        result.path.push_back(p);
    }
    return result;
}

// Splits a triangle in three at the mesh vertex nearest to its middle. False when there is none.
bool split_triangle(PatchComplex& complex, Index face, OverlayBuilder& builder)
{
    const std::vector<PatchComplex::Side> border = complex.faces()[face].sides;
    const auto disk = map_disk(builder, complex.geometry(border));
    if (!disk)
        return false;
    Index center = invalid_index;
    double nearest = std::numeric_limits<double>::infinity();
    for (Index v = disk->overlay.boundary_count; v < disk->overlay.vertices.size(); ++v)
        if (disk->overlay.vertices[v].mesh_vertex != invalid_index && norm(disk->uv[v]) < nearest) {
            nearest = norm(disk->uv[v]);
            center = disk->overlay.vertices[v].mesh_vertex;
        }
    if (center == invalid_index)
        return false;
    const Index in = invalid_index;
    auto change = complex.plan({face}, border, {{0, in}, {1, in}, {2, in}}, *disk, center);
    if (change)
        complex.apply(std::move(*change));
    return change.has_value();
}

} // namespace

namespace {

// Leaves of the candidates what the wishes allow: of the two triangles of a wanted pair no other.
void apply_wishes(const PatchComplex& complex, const PairingWishes& wishes, Candidates& candidates)
{
    std::vector<Index> only(complex.faces().size(), invalid_index); // Path to join over.
    std::vector<char> never(complex.paths().size(), 0);
    for (const auto& [a, b] : wishes.joined)
        if (const auto p = complex.path_between(a, b))
            only[complex.paths()[*p].left] = only[complex.paths()[*p].right] = *p;
    for (const auto& [a, b] : wishes.parted)
        if (const auto p = complex.path_between(a, b))
            never[*p] = 1;
    Candidates left;
    for (std::size_t i = 0; i < candidates.pairs.size(); ++i) {
        const PairCandidate& c = candidates.pairs[i];
        const Index p = candidates.path[i];
        const auto free = [&](Index face) {
            return only[face] == invalid_index || only[face] == p;
        };
        if (never[p] || !free(c.face_a) || !free(c.face_b))
            continue;
        left.pairs.push_back(c);
        left.path.push_back(p);
    }
    candidates = std::move(left);
}

bool is_wanted(const PairingWishes& wishes, const SurfacePath& path)
{
    return std::any_of(wishes.joined.begin(), wishes.joined.end(), [&path](const auto& pair) {
        return std::minmax(pair.first, pair.second) == std::minmax(path.a, path.b);
    });
}

} // namespace

Result<bool> pair_triangles(PatchComplex& complex, const PairingWishes& wishes, Context& context)
{
    for (int round = 0; round <= max_split_rounds; ++round) {
        auto candidates = find_candidates(complex, context);
        if (!candidates)
            return Context::cancelled_error("pairing");
        apply_wishes(complex, wishes, *candidates);
        const Index count = static_cast<Index>(complex.faces().size());
        const auto chosen = match_faces(count, candidates->pairs, bottleneck_slack);
        if (chosen) {
            for (const Index c : *chosen) {
                const PatchComplex::Path& path = complex.paths()[candidates->path[c]];
                const std::vector<Index> faces{path.left, path.right};
                const bool frozen = is_wanted(wishes, path.geometry);
                const Index quad = complex.apply({faces, *complex.border(faces), {}, {}});
                if (frozen)
                    complex.freeze(quad);
            }
            for (const auto& [a, b] : wishes.parted)
                if (const auto p = complex.path_between(a, b))
                    complex.mark(*p, joint_mark);
            complex.compact();
            return true;
        }
        OverlayBuilder builder(complex.mesh());
        bool changed = false;
        for (const Index f : blocking_faces(count, candidates->pairs))
            changed = split_triangle(complex, f, builder) || changed;
        complex.compact();
        if (!changed)
            break;
    }
    return false;
}

} // namespace bot2nurbs
