// SPDX-License-Identifier: MIT
#include "fit/fold_response.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

//! Damping of a quad that folds although it is held: first as much as its own diagonal, then ten
//! times as much each time.
constexpr double first_damping = 1.0;
constexpr double damping_factor = 10.0;
//! Neighbours are damped by this share, so that the step fades instead of breaking off.
constexpr double neighbour_share = 0.1;

} // namespace

FoldResponse::FoldResponse(const QuadComplex& complex, const ReducedNetwork& reduced)
    : complex_(complex), reduced_(reduced), held_(complex.quad_count(), 0),
      quad_damping_(complex.quad_count(), 0.0), damping_(reduced.free_count(), 0.0)
{
}

void FoldResponse::begin_round()
{
    std::fill(quad_damping_.begin(), quad_damping_.end(), 0.0);
    std::fill(damping_.begin(), damping_.end(), 0.0);
    damped_ = false;
}

void FoldResponse::damp(Index quad, double damping)
{
    quad_damping_[quad] = std::max(quad_damping_[quad], damping);
    for (Index p = quad * ReducedNetwork::pieces_per_quad;
         p < (quad + 1) * ReducedNetwork::pieces_per_quad; ++p)
        for (Index k = 0; k < reduced_.piece_size(p); ++k) {
            double& d = damping_[reduced_.piece_unknowns(p)[k]];
            d = std::max(d, damping);
        }
    damped_ = true;
}

std::vector<Index> FoldResponse::respond(const std::vector<Index>& folded)
{
    std::vector<Index> held, again;
    for (const Index q : folded)
        (held_[q] ? again : held).push_back(q);
    for (const Index q : held)
        held_[q] = 1;
    for (const Index q : again) {
        const double damping = std::max(first_damping, damping_factor * quad_damping_[q]);
        for (const Index n : with_neighbours({q}))
            damp(n, n == q ? damping : neighbour_share * damping);
    }
    return held;
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
