// SPDX-License-Identifier: MIT
#include "layout/trace_faces.h"

#include <cassert>

namespace bot2nurbs {

namespace {

// A chord as it leaves a corner or the point inside.
struct Leaving {
    TracedSide side;
    Index target; // Corner, or invalid for the point inside.
};

class Tracer {
public:
    Tracer(Index n, const std::vector<Chord>& chords) : n_(n), leaving_(n + 1)
    {
        for (Index i = 0; i < chords.size(); ++i) {
            const auto [a, b] = chords[i];
            leaving_[slot(a)].push_back({{true, i, false}, b});
            leaving_[slot(b)].push_back({{true, i, true}, a});
        }
    }

    // The piece to the left of the polygon's side `first`; marks the sides it uses.
    std::vector<TracedSide> piece(Index first, std::vector<char>& used) const
    {
        std::vector<TracedSide> sides{{false, first, false}};
        used[first] = 1;
        Index from = first, at = (first + 1) % n_;
        while (at != first) {
            const Leaving* way = at == invalid_index ? around_center(from) : leftmost(from, at);
            if (way) {
                sides.push_back(way->side);
                from = at;
                at = way->target;
            } else {
                sides.push_back({false, at, false});
                used[at] = 1;
                from = at;
                at = (at + 1) % n_;
            }
        }
        return sides;
    }

private:
    Index slot(Index corner) const { return corner == invalid_index ? n_ : corner; }
    Index ahead(Index from, Index to) const { return (to + n_ - from) % n_; }

    // At the point inside, having come from a corner: on to the next corner clockwise.
    const Leaving* around_center(Index from) const
    {
        const Leaving* best = nullptr;
        for (const Leaving& e : leaving_[n_])
            if (e.target != from && (!best || ahead(e.target, from) < ahead(best->target, from)))
                best = &e;
        assert(best);
        return best;
    }

    // At a corner: the chord that turns left most on the side of where we came from; none when the
    // polygon's next side does.
    const Leaving* leftmost(Index from, Index at) const
    {
        const Leaving* best = nullptr;
        Index best_offset = 0;
        const Index limit = from == invalid_index ? n_ : ahead(at, from);
        for (const Leaving& e : leaving_[at]) {
            if (e.target == from)
                continue;
            // A corner joined to the point inside has no chords on the near side of it.
            const Index offset = e.target == invalid_index ? n_ : ahead(at, e.target);
            if (e.target != invalid_index && offset > limit)
                continue;
            if (!best || offset > best_offset) {
                best = &e;
                best_offset = offset;
            }
        }
        return best;
    }

    Index n_;
    std::vector<std::vector<Leaving>> leaving_; // Index n: the point inside.
};

} // namespace

std::vector<std::vector<TracedSide>> trace_faces(Index corner_count,
                                                 const std::vector<Chord>& chords)
{
    const Tracer tracer(corner_count, chords);
    std::vector<std::vector<TracedSide>> pieces;
    std::vector<char> used(corner_count, 0);
    for (Index first = 0; first < corner_count; ++first)
        if (!used[first])
            pieces.push_back(tracer.piece(first, used));
    return pieces;
}

} // namespace bot2nurbs
