// SPDX-License-Identifier: MIT
#include "brep/hausdorff_search.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace bot2nurbs {

namespace {

//! What a lower bound may lose against the distance that a search found: a twentieth of the usual
//! gap.
constexpr double floor_share = 1e-3;
//! The same for the place that the lower bound is of, in the end.
constexpr double final_share = 1e-9;
//! Cells split together, the worst ones first. More would be split in vain when what is found in
//! one closes another; fewer would leave threads idle.
constexpr std::size_t batch_cells = 512;
//! Cells looked at, or places found, before the target is brought up to date.
constexpr std::size_t block_cells = 8192;
//! A cell takes a few microseconds, up to a hundred where many elements are in it.
constexpr std::size_t chunk_cells = 16;
//! Open cells at most, for they take 130 bytes each.
constexpr std::size_t most_open = 4000000;
//! Defaults of HausdorffOptions::max_cells.
constexpr std::uint64_t cells_per_element = 100, cells_at_least = 1000000;
//! A distance within this share of the diagonal of the one to decide about is left open rather than
//! refined for ever; the bounds say on which side it may be.
constexpr double tie_share = 1e-9;

constexpr std::array<HausdorffSide, 2> both_sides{HausdorffSide::surface, HausdorffSide::source};

auto cell_key(const HausdorffCell& c)
{
    const auto& [a, b, end] = c.corner;
    return std::make_tuple(c.side, c.element, c.level, a.x, a.y, b.x, b.y, end.x, end.y);
}

} // namespace

bool CellOrder::operator()(const HausdorffCell& a, const HausdorffCell& b) const
{
    const double x = a.bounds.max(), y = b.bounds.max();
    return x != y ? x < y : cell_key(a) > cell_key(b);
}

HausdorffSearch::HausdorffSearch(const ManifoldMesh& source, const QuadComplex& complex,
                                 const SplineSurface& surface, const HausdorffOptions& options,
                                 Context& context)
    : source_(source), context_(context), subject_(source, complex, surface, context),
      relative_gap_(options.relative_gap),
      absolute_gap_(subject_.to_unit(options.absolute_gap * source.box().diagonal())),
      tie_(subject_.to_unit(tie_share * source.box().diagonal())), max_cells_(options.max_cells)
{
    if (options.decide)
        decide_ = subject_.to_unit(*options.decide) - tie_; // What is closed is within it, then.
    if (max_cells_ == 0)
        max_cells_ = cells_at_least + cells_per_element * (std::uint64_t{subject_.piece_count()} +
                                                           source.face_count());
    for (auto& states : states_)
        states.resize(surface.patch_count());
}

double HausdorffSearch::target() const
{
    return decide_ ? *decide_ : std::max(lower_ / (1.0 - relative_gap_), lower_ + absolute_gap_);
}

bool HausdorffSearch::closed(const HausdorffCell& cell) const
{
    if (!decide_)
        return cell.bounds.max() <= target();
    for (int i = 0; i < cell.bounds.size; ++i) {
        const PatchBounds::Entry& e = cell.bounds.entry[i];
        if (!(e.bound <= *decide_ + tie_) && !(state(cell.side, e.patch).lower > *decide_))
            return false;
    }
    return true;
}

void HausdorffSearch::offer(const FoundPlace& place)
{
    if (place.patch == invalid_index)
        return;
    PatchState& s = state(place.side, place.patch);
    if (place.distance > s.beyond) {
        s.farthest = place;
        s.beyond = place.distance;
        s.proven = false;
    }
}

void HausdorffSearch::close(const HausdorffCell& cell)
{
    for (int i = 0; i < cell.bounds.size; ++i) {
        PatchState& s = state(cell.side, cell.bounds.entry[i].patch);
        s.upper = std::max(s.upper, cell.bounds.entry[i].bound);
    }
}

//! Proves the distances of the farthest places of some patches.
bool HausdorffSearch::prove(const std::vector<PatchState*>& which)
{
    if (!for_each_chunk(context_, which.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                PatchState& s = *which[i];
                const double found = s.farthest.distance;
                // Little may be lost when the distance is to be shown to be beyond another.
                const double share = decide_ && found > *decide_
                                         ? std::min(floor_share, 0.5 * (found - *decide_) / found)
                                         : floor_share;
                const double proven = subject_.floor(s.farthest, share);
                s.lower = std::max(s.lower, proven);
                // Where the search had missed a nearer place, others are farther than this one.
                s.beyond = proven < (1.0 - 2.0 * floor_share) * found ? proven : found;
                s.proven = true;
            }
        }))
        return false;
    queries_ += which.size();
    for (const PatchState* s : which) {
        const auto side = static_cast<std::size_t>(s->farthest.side);
        if (s->lower > proven_[side] || worst_[side].patch == invalid_index) {
            proven_[side] = s->lower;
            worst_[side] = s->farthest;
        }
        lower_ = std::max(lower_, s->lower);
    }
    return true;
}

//! Proves what matters for the target: the farthest places found so far, the farthest first.
bool HausdorffSearch::raise_lower()
{
    std::vector<PatchState*> far;
    for (auto& states : states_)
        for (PatchState& s : states)
            if (!s.proven && s.farthest.distance > interesting() &&
                !(decide_ && s.lower > *decide_))
                far.push_back(&s);
    if (decide_)
        return prove(far);
    std::stable_sort(far.begin(), far.end(), [](const PatchState* a, const PatchState* b) {
        return a->farthest.distance > b->farthest.distance;
    });
    for (PatchState* s : far)
        if (s->farthest.distance * (1.0 - floor_share) > lower_ && !prove({s}))
            return false;
    return true;
}

//! The middles of the pieces and the vertices of the source: where to start, and a first lower
//! bound.
bool HausdorffSearch::find_places()
{
    static constexpr Vec2 corner[3] = {{0, 0}, {1, 0}, {0, 1}};
    piece_places_.resize(subject_.piece_count());
    vertex_places_.resize(source_.vertex_count());
    const auto find_piece = [&](std::size_t i) {
        piece_places_[i] = subject_.find(HausdorffSide::surface, static_cast<Index>(i), {0.5, 0.5},
                                         invalid_index, INFINITY);
    };
    const auto find_vertex = [&](std::size_t i, double doubtful) {
        const Index h = source_.halfedge_at(static_cast<Index>(i));
        vertex_places_[i] = subject_.find(HausdorffSide::source, ManifoldMesh::face(h),
                                          corner[h % 3], invalid_index, doubtful);
    };
    const auto for_all = [&](std::size_t count, const auto& body) {
        return for_each_chunk(context_, count, chunk_cells,
                              [&](std::size_t begin, std::size_t end) {
                                  for (std::size_t i = begin; i < end; ++i)
                                      body(i);
                              });
    };
    if (!for_all(piece_places_.size(), find_piece) ||
        !for_all(vertex_places_.size(), [&](std::size_t i) { find_vertex(i, INFINITY); }))
        return false;
    for (const auto* places : {&piece_places_, &vertex_places_})
        for (const FoundPlace& place : *places)
            offer(place);
    if (!raise_lower())
        return false;
    // What is beyond the lower bound now was hidden by another place, or has a nearer one.
    if (!for_all(vertex_places_.size(), [&](std::size_t i) {
            if (vertex_places_[i].distance > interesting())
                find_vertex(i, interesting());
        }))
        return false;
    for (const FoundPlace& place : vertex_places_)
        offer(place);
    queries_ += piece_places_.size() + vertex_places_.size();
    return raise_lower();
}

//! Bounds cells; those that are not good enough are opened. `known` has a place for each, or is
//! empty.
bool HausdorffSearch::look_at(const std::vector<HausdorffCell>& cells,
                              const std::vector<FoundPlace>& known)
{
    std::vector<CellFindings> findings(cells.size());
    const double goal = target();
    if (!for_each_chunk(
            context_, cells.size(), chunk_cells, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    findings[i] = subject_.look_at(cells[i], known.empty() ? nullptr : &known[i],
                                                   goal, interesting());
            }))
        return false;
    cells_ += cells.size();
    for (const CellFindings& f : findings) {
        queries_ += static_cast<std::uint64_t>(f.queries);
        for (const FoundPlace& place : f.places)
            offer(place);
    }
    if (!raise_lower())
        return false;
    for (const CellFindings& f : findings) {
        if (closed(f.cell))
            close(f.cell);
        else
            open_.push(f.cell);
    }
    return true;
}

bool HausdorffSearch::bound_elements()
{
    const std::size_t pieces = piece_places_.size(), all = pieces + source_.face_count();
    std::vector<HausdorffCell> cells;
    std::vector<FoundPlace> known;
    for (std::size_t begin = 0; begin < all; begin += block_cells) {
        const std::size_t end = std::min(all, begin + block_cells);
        cells.resize(end - begin);
        known.resize(end - begin);
        for (std::size_t i = begin; i < end; ++i) {
            const bool piece = i < pieces;
            HausdorffCell& cell = cells[i - begin];
            FoundPlace& place = known[i - begin];
            cell = HausdorffCell::whole(piece ? HausdorffSide::surface : HausdorffSide::source,
                                        static_cast<Index>(piece ? i : i - pieces));
            if (piece) {
                place = piece_places_[i];
            } else {
                place = vertex_places_[source_.triangle(cell.element)[0]];
                place.element = cell.element;
                place.at = {0.0, 0.0};
            }
            cell.near = place.near;
        }
        if (!look_at(cells, known))
            return false;
        context_.progress(0.2 + 0.6 * static_cast<double>(end) / static_cast<double>(all));
    }
    piece_places_ = {};
    vertex_places_ = {};
    return true;
}

bool HausdorffSearch::refine()
{
    std::vector<HausdorffCell> parts;
    termination_ = decide_ ? HausdorffTermination::decided : HausdorffTermination::gap_reached;
    while (!open_.empty()) {
        parts.clear();
        while (!open_.empty() && parts.size() < 4 * batch_cells) {
            const HausdorffCell cell = open_.top();
            open_.pop();
            if (closed(cell)) {
                close(cell);
            } else if (cell.level >= HausdorffCell::most_levels || cells_ >= max_cells_ ||
                       open_.size() > most_open) {
                close(cell);
                termination_ = HausdorffTermination::cell_limit;
            } else {
                subject_.split(cell, parts);
            }
        }
        if (!look_at(parts, {}))
            return false;
        if (!open_.empty())
            context_.progress(0.8 + 0.2 * std::min(1.0, target() / open_.top().bounds.max()));
    }
    return true;
}

bool HausdorffSearch::run()
{
    if (context_.cancelled() || !find_places() || !bound_elements() || !refine())
        return false;
    std::vector<PatchState*> rest;
    for (auto& states : states_)
        for (PatchState& s : states)
            if (!s.proven && s.farthest.distance > s.lower)
                rest.push_back(&s);
    if (!prove(rest))
        return false;
    for (const HausdorffSide side : both_sides) {
        const FoundPlace& worst = worst_[static_cast<std::size_t>(side)];
        if (worst.patch == invalid_index)
            continue;
        double& proven = proven_[static_cast<std::size_t>(side)];
        proven = std::max(proven, subject_.floor(worst, final_share));
        state(side, worst.patch).lower = proven;
    }
    return true;
}

HausdorffBound HausdorffSearch::result() const
{
    HausdorffBound out;
    out.patches.resize(states_[0].size());
    for (const HausdorffSide side : both_sides) {
        const bool surface = side == HausdorffSide::surface;
        OneSidedDistance& all = surface ? out.surface_to_source : out.source_to_surface;
        const auto number = static_cast<std::size_t>(side);
        if (worst_[number].patch != invalid_index)
            all.worst = subject_.far_place(worst_[number], proven_[number]);
        for (Index q = 0; q < out.patches.size(); ++q) {
            const PatchState& s = state(side, q);
            DistanceBounds& patch =
                surface ? out.patches[q].surface_to_source : out.patches[q].source_to_surface;
            patch = {subject_.from_unit(s.lower), subject_.from_unit(std::max(s.lower, s.upper))};
            all.lower = std::max(all.lower, patch.lower);
            all.upper = std::max(all.upper, patch.upper);
        }
    }
    out.termination = termination_;
    out.cells = cells_;
    out.queries = queries_;
    return out;
}

} // namespace bot2nurbs
