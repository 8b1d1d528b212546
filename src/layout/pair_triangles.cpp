// SPDX-License-Identifier: MIT
#include "layout/pair_triangles.h"

#include "core/parallel.h"
#include "layout/face_energy.h"
#include "layout/pairing.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <cmath>
#include <limits>

namespace bot2nurbs {

namespace {

// What an edge less at a vertex is worth against distortion, per edge the vertex has above six.
constexpr double valence_weight = 0.35;
// Total cost is lowered among pairings whose worst distortion is within this factor of the optimum.
constexpr double bottleneck_slack = 1.3;

} // namespace

Result<bool> pair_triangles(PatchComplex& complex, Context& context)
{
    std::vector<int> valence(complex.mesh().vertex_count(), 0);
    for (const auto& p : complex.paths())
        if (p.alive)
            ++valence[p.geometry.a], ++valence[p.geometry.b];
    const double infinity = std::numeric_limits<double>::infinity();
    std::vector<double> distortion(complex.paths().size(), infinity);
    oneapi::tbb::enumerable_thread_specific<OverlayBuilder> builders(
        [&complex] { return OverlayBuilder(complex.mesh()); });
    const bool finished =
        for_each_chunk(context, distortion.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t p = begin; p < end; ++p) {
                const PatchComplex::Path& path = complex.paths()[p];
                if (!path.alive || complex.is_boundary(static_cast<Index>(p)))
                    continue;
                const auto border = complex.border({path.left, path.right});
                if (border && border->size() == 4)
                    distortion[p] = face_distortion(complex.geometry(*border), builders.local());
            }
        });
    if (!finished)
        return Context::cancelled_error("pairing");
    std::vector<PairCandidate> candidates;
    std::vector<Index> path_of;
    for (Index p = 0; p < complex.paths().size(); ++p) {
        if (!std::isfinite(distortion[p]))
            continue;
        const PatchComplex::Path& path = complex.paths()[p];
        PairCandidate c;
        c.face_a = path.left;
        c.face_b = path.right;
        c.distortion = distortion[p];
        // A triangle vertex of valence six that loses two edges has four; what joining across an
        // edge does to a vertex is counted from there.
        const double a = static_cast<double>(valence[path.geometry.a]) - 6.0;
        const double b = static_cast<double>(valence[path.geometry.b]) - 6.0;
        c.cost = c.distortion - valence_weight * (a + b);
        candidates.push_back(c);
        path_of.push_back(p);
    }
    const auto chosen =
        match_faces(static_cast<Index>(complex.faces().size()), candidates, bottleneck_slack);
    if (!chosen)
        return false;
    for (const Index c : *chosen) {
        const PatchComplex::Path& path = complex.paths()[path_of[c]];
        const std::vector<Index> faces{path.left, path.right};
        complex.apply({faces, *complex.border(faces), {}, {}});
    }
    complex.compact();
    return true;
}

} // namespace bot2nurbs
