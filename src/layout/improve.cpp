// SPDX-License-Identifier: MIT
#include "layout/improve.h"

#include "core/parallel.h"
#include "layout/moves.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bot2nurbs {

namespace {

using Side = PatchComplex::Side;
using Kind = Move::Kind;

// A change must lower the energy by this much, so that rounding does not make it cycle.
constexpr double min_gain = 1e-3;
// Rounds of one kind of move, and turns of all kinds: most of the gain is in the first, and what
// did not change is not tried again.
constexpr int max_rounds = 12;
constexpr int triangle_turns = 2;
constexpr int quad_turns = 3;
// While a patch is worse than this, up to so many more.
constexpr double bad_energy = 5.0;
constexpr int max_turns = 10;
// A closed surface of quads with fewer than this is left as it is.
constexpr Index min_faces = 3;
// While there are more than this factor times the wanted quads, one quad less is worth this much.
constexpr double count_slack = 1.1;
constexpr double surplus_credit = 1.5;

// Lowers the energy by rounds: all moves that may help are worked out side by side against the same
// state; then the best are done, in order of gain, as long as no other has changed their disk. So
// the result does not depend on the number of threads, nor on the numbering of paths but for ties.
class Improver {
public:
    Improver(PatchComplex& complex, Index sides, Index min_quads, const SizeMetric& metric,
             Context& context)
        : state_{complex, sides, metric, Valences(complex, sides), {}}, complex_(complex),
          min_quads_(min_quads), context_(context)
    {
        find_energies();
    }

    void run()
    {
        const bool quads = state_.sides == 4;
        Mark topology = 0, place = 0;
        for (int turn = 0; turn < max_turns && !context_.cancelled(); ++turn) {
            if (turn >= (quads ? quad_turns : triangle_turns) && worst_energy() < bad_energy)
                break;
            const Index before = last_face();
            rounds([this](Index mark) { return topological_moves(mark); }, topology);
            rounds([this](Index mark) { return moves_at_vertices(Kind::relocate, mark); }, place);
            if (last_face() == before)
                break;
        }
        if (quads) {
            Mark once = 0;
            round(moves_at_paths(Kind::straighten, 0), once);
            remove_degenerate();
        }
    }

private:
    // Number of faces, dead ones included, when moves were last worked out: a disk without a newer
    // face gains as little now as it did then.
    using Mark = Index;

    Index last_face() const { return static_cast<Index>(complex_.faces().size()); }

    void find_energies()
    {
        state_.energies.resize(last_face());
        for_each_chunk(context_, last_face(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t f = begin; f < end; ++f)
                if (complex_.faces()[f].alive())
                    state_.energies[f] = face_energy(complex_.geometry(complex_.faces()[f].sides),
                                                     state_.metric, builders_.local());
        });
    }
    double worst_energy() const
    {
        double worst = 0.0;
        for (Index f = 0; f < last_face(); ++f)
            if (complex_.faces()[f].alive())
                worst = std::max(worst, state_.energies[f].energy);
        return worst;
    }
    // What one quad less is worth.
    double credit(Kind kind) const
    {
        return kind == Kind::collapse && complex_.face_count() > count_slack * min_quads_
                   ? surplus_credit
                   : 0.0;
    }
    bool may_lose_face(Kind kind) const
    {
        if (kind == Kind::collapse)
            return complex_.face_count() > min_quads_;
        return kind != Kind::merge || complex_.face_count() > min_faces;
    }
    bool is_new(const std::vector<Index>& faces, Mark mark) const
    {
        return std::any_of(faces.begin(), faces.end(), [mark](Index f) { return f >= mark; });
    }

    std::vector<Move> moves_at_paths(Kind kind, Mark mark) const
    {
        std::vector<Move> moves;
        for (Index p = 0; p < complex_.paths().size(); ++p) {
            const PatchComplex::Path& path = complex_.paths()[p];
            if (!path.alive || complex_.is_fixed(p) || !is_new({path.left, path.right}, mark))
                continue;
            for (Index turn = 1; turn + 1 < (kind == Kind::rotate ? state_.sides : 3); ++turn)
                moves.push_back({kind, {p, false}, turn});
        }
        return moves;
    }
    std::vector<Move> moves_at_vertices(Kind kind, Mark mark) const
    {
        std::vector<Move> moves;
        for (const Side& s : complex_.vertex_sides())
            if (is_new(complex_.faces_around(s), mark))
                moves.push_back({kind, s, 0});
        return moves;
    }
    std::vector<Move> collapses(Mark mark) const
    {
        std::vector<Move> moves;
        for (Index f = 0; f < last_face(); ++f)
            for (const Side& s : complex_.faces()[f].sides)
                if (is_new(complex_.faces_around(s), mark))
                    moves.push_back({Kind::collapse, s, 0});
        return moves;
    }
    std::vector<Move> topological_moves(Mark mark) const
    {
        std::vector<Move> moves = moves_at_paths(Kind::rotate, mark);
        if (state_.sides == 4) {
            for (std::vector<Move> more : {moves_at_vertices(Kind::merge, mark), collapses(mark)})
                moves.insert(moves.end(), more.begin(), more.end());
        }
        return moves;
    }

    template <class MoveSource> void rounds(const MoveSource& source, Mark& mark)
    {
        for (int i = 0; i < max_rounds && !context_.cancelled(); ++i)
            if (round(source(mark), mark) == 0)
                break;
    }
    // \return how many moves were done.
    Index round(const std::vector<Move>& moves, Mark& mark)
    {
        mark = last_face();
        std::vector<std::optional<Proposal>> proposals(moves.size());
        for_each_chunk(context_, moves.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                if (may_lose_face(moves[i].kind))
                    proposals[i] = propose(state_, moves[i], credit(moves[i].kind), min_gain,
                                           builders_.local());
        });
        if (context_.cancelled())
            return 0;
        std::vector<std::pair<double, std::size_t>> order;
        for (std::size_t i = 0; i < moves.size(); ++i)
            if (proposals[i])
                order.emplace_back(gain(moves[i].kind, *proposals[i]), i);
        std::stable_sort(order.begin(), order.end(),
                         [](const auto& a, const auto& b) { return a.first > b.first; });
        Index done = 0;
        for (const auto& [expected, i] : order) {
            Proposal& p = *proposals[i];
            if (!may_lose_face(moves[i].kind) || !is_possible(state_, p) ||
                !(gain(moves[i].kind, p) > min_gain))
                continue;
            apply(std::move(p));
            ++done;
        }
        return done;
    }
    double gain(Kind kind, const Proposal& p) const
    {
        return credit(kind) - p.energy_change - valence_change(state_, p);
    }
    void apply(Proposal p)
    {
        if (p.moved_to != invalid_index)
            state_.valences.move(p.gone, p.moved_to);
        else if (p.gone != invalid_index)
            state_.valences.add(p.gone, -state_.valences[p.gone]);
        for (const auto& [v, by] : p.valences)
            state_.valences.add(v, by);
        complex_.apply(std::move(p.change));
        state_.energies.insert(state_.energies.end(), p.energies.begin(), p.energies.end());
    }

    // Removes what degenerate vertices are left, each by the change that distorts least: an edge
    // turned towards it or, where it has degree two, merging its two quads.
    // Ends: a merge makes the quads fewer, a turn makes such vertices fewer.
    void remove_degenerate()
    {
        bool changed = true;
        while (changed && !context_.cancelled() && complex_.face_count() > min_faces) {
            changed = false;
            for (const Side& s : complex_.vertex_sides()) {
                if (!complex_.paths()[s.path].alive ||
                    !state_.valences.is_degenerate(complex_.start(s)))
                    continue;
                if (std::optional<Proposal> best = best_removal(s)) {
                    apply(std::move(*best));
                    changed = true;
                }
            }
        }
    }
    std::optional<Proposal> best_removal(const Side& at_v)
    {
        const Index v = complex_.start(at_v);
        std::vector<Move> moves{{Kind::merge, at_v, 0}};
        for (const Side& spoke : complex_.star(at_v)) {
            if (complex_.face_at(spoke) == invalid_index)
                continue;
            const Side first = complex_.next(spoke);
            for (const Side& outer : {first, complex_.next(first)})
                for (const Index turn : {1u, 2u})
                    moves.push_back({Kind::rotate, outer, turn});
        }
        std::optional<Proposal> best;
        for (const Move& move : moves) {
            const double any = std::numeric_limits<double>::infinity();
            std::optional<Proposal> p = propose(state_, move, any, 0.0, builders_.local());
            if (!p || (move.kind == Kind::rotate && !removes_degenerate(*p, v)))
                continue;
            if (!best || gain(move.kind, *p) > gain(Kind::merge, *best))
                best = std::move(p);
        }
        return best;
    }
    // Whether a turn gives vertex v an edge and makes no other vertex degenerate.
    bool removes_degenerate(const Proposal& p, Index v) const
    {
        bool gains = false;
        for (const auto& [w, by] : p.valences) {
            if (by < 0 && state_.valences.is_degenerate(w, by))
                return false;
            gains = gains || (w == v && by > 0);
        }
        return gains;
    }

    ComplexState state_;
    PatchComplex& complex_;
    Index min_quads_;
    Context& context_;
    oneapi::tbb::enumerable_thread_specific<OverlayBuilder> builders_{
        [this] { return OverlayBuilder(complex_.mesh()); }};
};

} // namespace

void improve_triangles(PatchComplex& complex, const SizeMetric& metric, Context& context)
{
    Improver(complex, 3, 0, metric, context).run();
    complex.compact();
}

void improve_quads(PatchComplex& complex, Index min_quads, const SizeMetric& metric,
                   Context& context)
{
    Improver(complex, 4, min_quads, metric, context).run();
    complex.compact();
}

} // namespace bot2nurbs
