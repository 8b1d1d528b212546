// SPDX-License-Identifier: MIT
#include "fit/fold_response.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

//! The point-distance part of a quad's rows grows by this each time it folds: a hundred times at
//! once leaves the rms of real models up to a tenth higher.
constexpr double mu_growth = 10.0;

} // namespace

FoldResponse::FoldResponse(const QuadComplex& complex, const ReducedNetwork& reduced)
    : complex_(complex), reduced_(reduced), least_mu_(complex.quad_count(), 0.0)
{
}

void FoldResponse::respond(const std::vector<Index>& folded, double mu)
{
    for (const Index q : folded)
        least_mu_[q] = std::min(1.0, mu_growth * std::max(mu, least_mu_[q]));
}

void FoldResponse::shorten(const std::vector<Index>& quads, double share,
                           std::vector<Vec3>& move) const
{
    std::vector<char> done(move.size(), 0);
    for (const Index q : quads)
        for (Index p = q * ReducedNetwork::pieces_per_quad;
             p < (q + 1) * ReducedNetwork::pieces_per_quad; ++p)
            for (Index k = 0; k < reduced_.piece_size(p); ++k) {
                const Index i = reduced_.piece_unknowns(p)[k];
                if (!done[i])
                    move[i] *= share;
                done[i] = 1;
            }
}

std::vector<Index> FoldResponse::with_neighbours(const std::vector<Index>& quads) const
{
    std::vector<Index> all = quads;
    for (const Index q : quads)
        for (const Index v : complex_.quad(q)) {
            const Index first = complex_.halfedge_at(v);
            for (Index h = first; h != invalid_index;) {
                all.push_back(QuadComplex::quad_of(h));
                h = complex_.rotate_ccw(h);
                if (h == first)
                    break;
            }
        }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

std::vector<Index> more_folded(const std::vector<Index>& before, const std::vector<Index>& after)
{
    std::vector<Index> quads;
    for (std::size_t q = 0; q < before.size(); ++q)
        if (after[q] > before[q])
            quads.push_back(static_cast<Index>(q));
    return quads;
}

} // namespace bot2nurbs
