// SPDX-License-Identifier: MIT
#include "layout/improve.h"

#include "core/parallel.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bot2nurbs {

namespace {

using Side = PatchComplex::Side;

// What one unit of (valence - 4)^2 costs against the energy of a patch (a square of the wanted size
// has 1).
constexpr double valence_weight = 0.35;
// A change must lower the energy by this much, so that rounding does not make it cycle.
constexpr double min_gain = 1e-3;
// Rounds of improvement: most of the gain is in the first, and each costs some ten times as much as
// mapping every patch once.
constexpr int triangle_passes = 2;
constexpr int quad_passes = 3;
// While a patch is worse than this, up to so many more; what did not change is not tried again.
constexpr double bad_energy = 5.0;
constexpr int max_passes = 10;
// A vertex this near to the middle of its star, over the star's radius, stays.
constexpr double middle_enough = 0.12;
// A closed surface of quads with fewer than this is left as it is.
constexpr Index min_faces = 3;
// While there are more than this factor times the wanted quads, one quad less is worth this much.
constexpr double count_slack = 1.1;
constexpr double surplus_credit = 1.5;
// Largest valence a change may make in K: the masks grow fast beyond. In K_tri a vertex has half as
// many edges again.
constexpr int max_quad_valence = 6;
constexpr int max_triangle_valence = 9;

// The splines do not exist at vertices of degree two. They are worth this much to remove, so that
// it is done by whatever change distorts least, and never made.
constexpr double doublet_cost = 10.0;

// Penalty for the valence of a vertex between faces of three or four sides.
double valence_cost(Index sides, int valence)
{
    if (sides == 4 && valence == 2)
        return doublet_cost;
    const double d = static_cast<double>(valence) - (sides == 3 ? 6.0 : 4.0);
    return valence_weight * d * d;
}

// The state of K_tri or K while it is improved: energy per face and valence per mesh vertex.
class Improver {
public:
    Improver(PatchComplex& complex, Index sides, Index min_quads, const SizeMetric& metric,
             Context& context)
        : complex_(complex), sides_(sides),
          max_valence_(sides == 3 ? max_triangle_valence : max_quad_valence), min_quads_(min_quads),
          metric_(metric), context_(context)
    {
        valence_.assign(complex.mesh().vertex_count(), 0);
        vertex_tried_.assign(complex.mesh().vertex_count(), 0);
        for (const auto& p : complex.paths())
            if (p.alive)
                ++valence_[p.geometry.a], ++valence_[p.geometry.b];
    }

    void run()
    {
        find_states(0);
        const int passes = sides_ == 3 ? triangle_passes : quad_passes;
        for (int pass = 0; pass < max_passes && !context_.cancelled(); ++pass) {
            if (pass >= passes && worst_energy() < bad_energy)
                break;
            rotate_edges();
            if (sides_ == 4) {
                remove_doublets(false);
                collapse_quads();
                rotate_edges();
            }
            relocate_vertices();
        }
        if (sides_ == 4) {
            straighten_edges();
            if (!context_.cancelled())
                remove_doublets(true);
        }
    }

private:
    double cost(int valence) const { return valence_cost(sides_, valence); }
    struct FaceState {
        double energy = -1.0; // Negative: not known.
        double size = 0.0;
    };
    // Finds the states of the faces from a number on, side by side.
    void find_states(Index first)
    {
        const Index last = static_cast<Index>(complex_.faces().size());
        states_.resize(last);
        for_each_chunk(context_, last - first, 1, [&](std::size_t begin, std::size_t end) {
            OverlayBuilder& builder = builders_.local();
            for (std::size_t f = first + begin; f < first + end; ++f)
                if (states_[f].energy < 0.0 && complex_.faces()[f].alive())
                    states_[f].energy = face_energy(complex_, complex_.faces()[f].sides, metric_,
                                                    builder, &states_[f].size);
        });
    }
    const FaceState& state(Index f)
    {
        if (states_.size() <= f)
            states_.resize(f + 1);
        if (states_[f].energy < 0.0)
            states_[f].energy = face_energy(complex_, complex_.faces()[f].sides, metric_,
                                            builders_.local(), &states_[f].size);
        return states_[f];
    }
    double worst_energy()
    {
        double worst = 0.0;
        for (Index f = 0; f < complex_.faces().size(); ++f)
            if (complex_.faces()[f].alive())
                worst = std::max(worst, state(f).energy);
        return worst;
    }
    // Forgets the states of faces from a number on: that number will be used anew.
    void forget_from(Index first) { states_.resize(std::min<std::size_t>(states_.size(), first)); }

    // Whether an edge joins the start of a side to vertex b.
    bool adjacent(const Side& at_a, Index b) const
    {
        for (const Side& s : complex_.star(at_a))
            if (complex_.end(s) == b)
                return true;
        return false;
    }

    // Replaces and keeps the change when it lowers the energy; `valence_change` is that of the
    // valence terms, already counted by the caller.
    bool attempt(const std::vector<Index>& faces, const std::vector<Side>& border,
                 const std::vector<std::pair<Index, Index>>& chords, double valence_change,
                 const MappedDisk* disk = nullptr, Index center = invalid_index)
    {
        double before = 0.0, size = 0.0;
        for (const Index f : faces) {
            before += state(f).energy;
            size += state(f).size;
        }
        const double allowed = before - valence_change - min_gain;
        // However the disk is divided, distortion is at least one and sizes add up to the same.
        const double count = static_cast<double>(chords.size()) + (center == invalid_index ? 1 : 0);
        if (!(allowed > size * size / count))
            return false;
        if (!(disk ? complex_.replace(faces, border, chords, *disk, center)
                   : complex_.replace(faces, border, chords)))
            return false;
        const Index first = static_cast<Index>(complex_.faces().size()) - complex_.new_face_count();
        forget_from(first);
        find_states(first);
        double after = 0.0;
        for (Index f = first; f < complex_.faces().size(); ++f)
            after += state(f).energy;
        if (after < allowed)
            return true;
        complex_.undo();
        forget_from(first);
        return false;
    }

    void remove_doublets(bool all);
    bool rotate_to_doublet(const Side& at_v, double limit);
    double energy_after(const std::vector<Index>& faces, const std::vector<Side>& border,
                        const std::vector<std::pair<Index, Index>>& chords);
    void rotate_edges();
    void collapse_quads();
    void relocate_vertices();
    void straighten_edges();
    bool try_collapse(const Side& at_v);

    // One side that starts at each vertex of K, by vertex.
    std::vector<Side> vertex_sides() const
    {
        std::vector<Side> at(valence_.size());
        for (Index p = 0; p < complex_.paths().size(); ++p)
            if (complex_.paths()[p].alive) {
                const SurfacePath& g = complex_.paths()[p].geometry;
                if (at[g.a].path == invalid_index)
                    at[g.a] = {p, false};
                if (at[g.b].path == invalid_index)
                    at[g.b] = {p, true};
            }
        std::vector<Side> result;
        for (const Side& s : at)
            if (s.path != invalid_index)
                result.push_back(s);
        return result;
    }
    // Faces get new, larger numbers when they change: whether any has since faces().size() was
    // `mark`. What did not lower the energy then will not now.
    static bool changed_since(const std::vector<Index>& faces, Index mark)
    {
        return std::any_of(faces.begin(), faces.end(), [mark](Index f) { return f >= mark; });
    }
    bool alive(const Side& s) const { return complex_.paths()[s.path].alive; }

    PatchComplex& complex_;
    oneapi::tbb::enumerable_thread_specific<OverlayBuilder> builders_{
        [this] { return OverlayBuilder(complex_.mesh()); }};
    Index sides_; // Of every face.
    int max_valence_;
    Index min_quads_;
    const SizeMetric& metric_;
    Context& context_;
    std::vector<int> valence_;        // Per mesh vertex.
    std::vector<FaceState> states_;   // Per face.
    std::vector<Index> vertex_tried_; // Per mesh vertex: number of faces at the last relocation.
};

void Improver::remove_doublets(bool all)
{
    bool changed = true;
    while (changed) {
        changed = false;
        for (const Side& s : vertex_sides()) {
            const Index v = complex_.start(s);
            if (valence_[v] != 2 || !alive(s) || complex_.face_count() <= min_faces)
                continue;
            const std::vector<Index> faces{complex_.face_at(s),
                                           complex_.face_at({s.path, !s.reversed})};
            const auto border = complex_.border(faces);
            if (!border || border->size() != 4)
                continue;
            const Index a = complex_.end(s), b = complex_.start(complex_.previous(s));
            const double change = -doublet_cost + cost(valence_[a] - 1) - cost(valence_[a]) +
                                  cost(valence_[b] - 1) - cost(valence_[b]);
            if (!attempt(faces, *border, {}, change)) {
                if (!all)
                    continue;
                if (rotate_to_doublet(s, energy_after(faces, *border, {}))) {
                    changed = true;
                    continue;
                }
                complex_.replace(faces, *border, {});
                forget_from(static_cast<Index>(complex_.faces().size()) - 1);
            }
            valence_[v] = 0;
            --valence_[a], --valence_[b];
            changed = true;
        }
    }
}

// By how much a change raises the energy of faces; the change is taken back.
double Improver::energy_after(const std::vector<Index>& faces, const std::vector<Side>& border,
                              const std::vector<std::pair<Index, Index>>& chords)
{
    double change = 0.0;
    for (const Index f : faces)
        change -= state(f).energy;
    if (!complex_.replace(faces, border, chords))
        return std::numeric_limits<double>::infinity();
    const Index count = static_cast<Index>(complex_.faces().size());
    for (Index f = count - complex_.new_face_count(); f < count; ++f)
        change += face_energy(complex_, complex_.faces()[f].sides, metric_, builders_.local());
    complex_.undo();
    return change;
}

// Where merging the two quads at a vertex of degree two would squeeze a limb into one patch
// (raising the energy by `limit`), an outer edge of the two is turned towards the vertex instead,
// if that distorts less. Takes the best of the four edges.
bool Improver::rotate_to_doublet(const Side& at_v, double limit)
{
    const Index v = complex_.start(at_v);
    struct Turn {
        Index path;
        std::vector<Index> faces;
        std::vector<Side> border;
        Index from, to;
    };
    std::optional<Turn> best;
    for (const Side& spoke :
         {at_v, Side{complex_.previous(at_v).path, !complex_.previous(at_v).reversed}}) {
        const Side first = complex_.next(spoke);
        for (const Side& outer : {first, complex_.next(first)}) {
            const Index a = complex_.start(outer), b = complex_.end(outer);
            if (valence_[a] < 4 || valence_[b] < 4)
                continue;
            const std::vector<Index> faces{complex_.face_at(outer),
                                           complex_.face_at({outer.path, !outer.reversed})};
            const auto border = complex_.border(faces);
            if (!border || border->size() != 6)
                continue;
            Index from = 0;
            while (from < 6 && complex_.start((*border)[from]) != v)
                ++from;
            if (from == 6)
                continue;
            const Index to = (from + 3) % 6, target = complex_.start((*border)[to]);
            if (valence_[target] >= max_valence_ || adjacent((*border)[from], target))
                continue;
            const double change = energy_after(faces, *border, {{from, to}});
            if (change < limit) {
                limit = change;
                best = Turn{outer.path, faces, *border, from, to};
            }
        }
    }
    if (!best || !complex_.replace(best->faces, best->border, {{best->from, best->to}}))
        return false;
    forget_from(static_cast<Index>(complex_.faces().size()) - complex_.new_face_count());
    const SurfacePath& gone = complex_.paths()[best->path].geometry;
    --valence_[gone.a], --valence_[gone.b];
    ++valence_[v], ++valence_[complex_.start(best->border[best->to])];
    return true;
}

void Improver::rotate_edges()
{
    const Index count = static_cast<Index>(complex_.paths().size());
    for (Index p = 0; p < count && !context_.cancelled(); ++p) {
        if (!complex_.paths()[p].alive)
            continue;
        const Side s{p, false};
        const Index a = complex_.start(s), b = complex_.end(s);
        const int least = sides_ == 3 ? 4 : 3;
        if (valence_[a] < least || valence_[b] < least)
            continue;
        const std::vector<Index> faces{complex_.face_at(s), complex_.face_at({p, true})};
        const auto border = complex_.border(faces);
        const Index n = 2 * sides_ - 2;
        if (!border || border->size() != n)
            continue;
        Index ia = 0;
        while (complex_.start((*border)[ia]) != a)
            ++ia;
        for (Index turn = 1; turn + 1 < sides_; ++turn) {
            const Index ic = (ia + turn) % n, id = (ia + turn + sides_ - 1) % n;
            const Index c = complex_.start((*border)[ic]), d = complex_.start((*border)[id]);
            if (valence_[c] + 1 > max_valence_ || valence_[d] + 1 > max_valence_ ||
                adjacent((*border)[ic], d))
                continue;
            const double change = cost(valence_[a] - 1) - cost(valence_[a]) +
                                  cost(valence_[b] - 1) - cost(valence_[b]) +
                                  cost(valence_[c] + 1) - cost(valence_[c]) +
                                  cost(valence_[d] + 1) - cost(valence_[d]);
            if (attempt(faces, *border, {{ic, id}}, change)) {
                --valence_[a], --valence_[b], ++valence_[c], ++valence_[d];
                break;
            }
        }
    }
}

bool Improver::try_collapse(const Side& at_v)
{
    // The quad to the left of at_v: v, e0, w, e1. v goes; its other edges move to w.
    const Index v = complex_.start(at_v);
    const std::vector<Side> star = complex_.star(at_v);
    const Index n = static_cast<Index>(star.size());
    const Index w = complex_.end(complex_.next(at_v));
    const Index e0 = complex_.end(at_v), e1 = complex_.end(star[1]);
    if (n < 3 || valence_[e0] < 4 || valence_[e1] < 4 ||
        valence_[w] + static_cast<int>(n) - 2 > max_valence_ || w == v)
        return false;
    std::vector<Index> faces;
    for (const Side& s : star)
        faces.push_back(complex_.face_at(s));
    const auto border = complex_.border(faces);
    if (!border || border->size() != 2 * n)
        return false;
    Index iw = 0;
    while (iw < 2 * n && complex_.start((*border)[iw]) != w)
        ++iw;
    if (iw == 2 * n)
        return false;
    std::vector<std::pair<Index, Index>> chords;
    for (Index k = 3; k + 2 < 2 * n; k += 2) {
        const Index i = (iw + k) % (2 * n);
        if (adjacent((*border)[iw], complex_.start((*border)[i])))
            return false;
        chords.emplace_back(iw, i);
    }
    const double change = -cost(valence_[v]) + cost(valence_[e0] - 1) - cost(valence_[e0]) +
                          cost(valence_[e1] - 1) - cost(valence_[e1]) +
                          cost(valence_[w] + static_cast<int>(n) - 2) - cost(valence_[w]);
    const double credit = complex_.face_count() > count_slack * static_cast<double>(min_quads_)
                              ? surplus_credit
                              : 0.0;
    if (!attempt(faces, *border, chords, change - credit))
        return false;
    valence_[v] = 0;
    --valence_[e0], --valence_[e1];
    valence_[w] += static_cast<int>(n) - 2;
    return true;
}

void Improver::collapse_quads()
{
    const Index count = static_cast<Index>(complex_.faces().size());
    for (Index f = 0; f < count && !context_.cancelled(); ++f) {
        if (complex_.face_count() <= min_quads_)
            return;
        if (!complex_.faces()[f].alive())
            continue;
        const std::vector<Side> sides = complex_.faces()[f].sides;
        for (const Side& s : sides)
            if (try_collapse(s))
                break;
    }
}

void Improver::relocate_vertices()
{
    for (const Side& found : vertex_sides()) {
        if (context_.cancelled())
            return;
        if (!alive(found))
            continue;
        const std::vector<Side> star = complex_.star(found);
        const Index n = static_cast<Index>(star.size());
        std::vector<Index> faces;
        for (const Side& s : star)
            faces.push_back(complex_.face_at(s));
        const auto border = complex_.border(faces);
        if (!border || border->size() != (sides_ - 2) * n)
            continue;
        const Index v = complex_.start(found);
        if (!changed_since(faces, vertex_tried_[v]))
            continue;
        // The mesh vertex nearest to the middle of the star's map.
        const auto disk = complex_.mapped(*border);
        if (!disk)
            continue;
        Vec2 middle;
        for (const Index c : disk->overlay.corners)
            middle = middle + (1.0 / static_cast<double>(border->size())) * disk->uv[c];
        Index center = invalid_index;
        double nearest = std::numeric_limits<double>::infinity(), now = 0.0;
        for (Index i = disk->overlay.boundary_count; i < disk->overlay.vertices.size(); ++i)
            if (disk->overlay.vertices[i].mesh_vertex != invalid_index &&
                norm(disk->uv[i] - middle) < nearest) {
                nearest = norm(disk->uv[i] - middle);
                center = disk->overlay.vertices[i].mesh_vertex;
            }
        for (Index i = disk->overlay.boundary_count; i < disk->overlay.vertices.size(); ++i)
            if (disk->overlay.vertices[i].mesh_vertex == v)
                now = norm(disk->uv[i] - middle);
        vertex_tried_[v] = static_cast<Index>(complex_.faces().size());
        const double radius = norm(disk->uv[disk->overlay.corners[0]] - middle);
        if (center == invalid_index || now - nearest < middle_enough * radius)
            continue;
        std::vector<std::pair<Index, Index>> chords;
        for (Index i = 0; i < border->size(); ++i) {
            const Index c = complex_.start((*border)[i]);
            for (const Side& s : star)
                if (complex_.end(s) == c)
                    chords.emplace_back(i, invalid_index);
        }
        if (chords.size() != n)
            continue;
        if (attempt(faces, *border, chords, 0.0, &*disk, center)) {
            valence_[v] = 0;
            valence_[center] = static_cast<int>(n);
        }
        vertex_tried_[center] = static_cast<Index>(complex_.faces().size());
        vertex_tried_[v] = vertex_tried_[center];
    }
}

void Improver::straighten_edges()
{
    const Index count = static_cast<Index>(complex_.paths().size());
    for (Index p = 0; p < count && !context_.cancelled(); ++p) {
        if (!complex_.paths()[p].alive)
            continue;
        const std::vector<Index> faces{complex_.paths()[p].left, complex_.paths()[p].right};
        const Index n = 2 * sides_ - 2;
        const auto border = complex_.border(faces);
        if (!border || border->size() != n)
            continue;
        Index ia = 0;
        while (complex_.start((*border)[ia]) != complex_.paths()[p].geometry.a)
            ++ia;
        attempt(faces, *border, {{ia, (ia + sides_ - 1) % n}}, 0.0);
    }
}

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
