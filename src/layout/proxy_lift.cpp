// SPDX-License-Identifier: MIT
#include "core/parallel.h"
#include "layout/proxy.h"
#include "maps/lift_chords.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>

namespace bot2nurbs {

namespace {

// Places on one step of a path keep this share of it from its ends and from each other: their order
// matters, where they are does not.
constexpr double place_margin = 0.02;

// One crossing of a coarse edge by a path of the complex.
struct Crossing {
    Index edge;
    double t;
    Index path;
    std::size_t node;
};

// Where on the fine path of its coarse edge, walked in the edge's direction, each crossing is.
struct EdgePlace {
    Index step = 0;
    double share = 0.0;
};

// Places of the crossings of one edge, which come in order of t: at those shares of the length of
// its path, kept apart within each step.
std::vector<EdgePlace> place_crossings(const ManifoldMesh& fine, const PathSide& along,
                                       const Crossing* first, std::size_t count)
{
    std::vector<double> arc{0.0};
    Vec3 last = fine.position(along.start());
    for (std::size_t i = 0; i <= along.node_count(); ++i) {
        Vec3 p = fine.position(along.end());
        if (i < along.node_count()) {
            const PathNode n = along.node(fine, i);
            p = n.is_vertex() ? fine.position(n.vertex)
                              : edge_point(fine, fine.edge(n.halfedge), n.t);
        }
        arc.push_back(arc.back() + norm(p - last));
        last = p;
    }
    std::vector<EdgePlace> places(count);
    Index step = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double at = first[i].t * arc.back();
        while (step + 2 < arc.size() && arc[step + 1] < at)
            ++step;
        const double length = arc[step + 1] - arc[step];
        places[i] = {step, length > 0.0 ? (at - arc[step]) / length : 0.5};
    }
    for (std::size_t i = 0; i < count;) {
        std::size_t j = i + 1;
        while (j < count && places[j].step == places[i].step)
            ++j;
        const double n = static_cast<double>(j - i);
        const double gap = std::min(place_margin, 0.5 / (n + 1.0));
        double at_least = gap;
        for (std::size_t k = i; k < j; ++k) {
            places[k].share = std::max(places[k].share, at_least);
            at_least = places[k].share + gap;
        }
        if (at_least > 1.0)
            for (std::size_t k = i; k < j; ++k)
                places[k].share = static_cast<double>(k - i + 1) / (n + 1.0);
        i = j;
    }
    return places;
}

// A step of a path of the complex: a chord of a coarse face, or along a path of the base.
struct Step {
    Index face = invalid_index;
    std::size_t chord = 0;
    PatchComplex::Side along;
};

} // namespace

Result<PatchComplex> Proxy::lift(const PatchComplex& complex, Context& context) const
{
    const ManifoldMesh& coarse = *mesh_;
    const ManifoldMesh& fine = fine_->mesh();

    std::vector<Crossing> crossings;
    std::vector<std::vector<EdgePlace>> place(complex.paths().size());
    for (Index p = 0; p < complex.paths().size(); ++p) {
        const auto& nodes = complex.paths()[p].geometry.nodes;
        place[p].resize(nodes.size());
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (!nodes[i].is_vertex())
                crossings.push_back({coarse.edge(nodes[i].halfedge), nodes[i].t, p, i});
    }
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
        return a.edge != b.edge ? a.edge < b.edge : a.t < b.t;
    });
    for (std::size_t i = 0; i < crossings.size();) {
        std::size_t j = i + 1;
        while (j < crossings.size() && crossings[j].edge == crossings[i].edge)
            ++j;
        const PathSide along = base_.geometry({side_[crossings[i].edge]}).front();
        const auto places = place_crossings(fine, along, &crossings[i], j - i);
        for (std::size_t k = i; k < j; ++k)
            place[crossings[k].path][crossings[k].node] = places[k - i];
        i = j;
    }

    // The place of a crossing as seen from the face of one of the edge's halfedges.
    const auto seen_from = [&](Index halfedge, EdgePlace at) {
        BorderPlace result{halfedge % 3, at.step, at.share};
        if (coarse.edge(halfedge) != halfedge) {
            const auto steps = base_.geometry({side_[halfedge]}).front().node_count();
            result.step = static_cast<Index>(steps) - at.step;
            result.share = 1.0 - at.share;
        }
        return result;
    };
    std::vector<std::vector<BorderChord>> chords(coarse.face_count());
    std::vector<std::vector<Step>> steps(complex.paths().size());
    for (Index p = 0; p < complex.paths().size(); ++p) {
        const SurfacePath& path = complex.paths()[p].geometry;
        const std::size_t n = path.nodes.size();
        const auto vertex_at = [&](std::size_t i) {
            return i == 0 ? path.a : i <= n ? path.nodes[i - 1].vertex : path.b;
        };
        for (std::size_t i = 0; i <= n; ++i) {
            const Index from = vertex_at(i), to = vertex_at(i + 1);
            Step step;
            if (from != invalid_index && to != invalid_index) {
                const Index h = coarse.find_halfedge(from, to);
                step.along = h != invalid_index
                                 ? side_[h]
                                 : PatchComplex::opposite(side_[coarse.find_halfedge(to, from)]);
                steps[p].push_back(step);
                continue;
            }
            // The face that the next crossing leaves, or that the last one led to.
            step.face = to == invalid_index
                            ? ManifoldMesh::face(path.nodes[i].halfedge)
                            : ManifoldMesh::face(coarse.twin(path.nodes[i - 1].halfedge));
            const auto corner = [&](Index v) {
                const auto& t = coarse.triangle(step.face);
                return BorderPlace{static_cast<Index>(std::find(t.begin(), t.end(), v) - t.begin()),
                                   0, 0.0};
            };
            BorderChord chord;
            chord.from = from != invalid_index
                             ? corner(from)
                             : seen_from(coarse.twin(path.nodes[i - 1].halfedge), place[p][i - 1]);
            chord.to =
                to != invalid_index ? corner(to) : seen_from(path.nodes[i].halfedge, place[p][i]);
            step.chord = chords[step.face].size();
            chords[step.face].push_back(chord);
            steps[p].push_back(step);
        }
    }

    std::vector<std::optional<std::vector<std::vector<PathNode>>>> drawn(coarse.face_count());
    oneapi::tbb::enumerable_thread_specific<OverlayBuilder> builders(
        [&fine] { return OverlayBuilder(fine); });
    const bool finished =
        for_each_chunk(context, coarse.face_count(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t f = begin; f < end; ++f)
                if (!chords[f].empty())
                    drawn[f] = lift_chords(base_.geometry(base_.faces()[f].sides), chords[f],
                                           builders.local());
        });
    if (!finished)
        return Context::cancelled_error("layout");
    for (Index f = 0; f < coarse.face_count(); ++f)
        if (!chords[f].empty() && !drawn[f])
            return Error{ErrorCode::layout_failed,
                         "face " + std::to_string(f) + " of the coarse mesh cannot be mapped", f};

    PatchComplex lifted(fine);
    for (Index p = 0; p < complex.paths().size(); ++p) {
        const SurfacePath& path = complex.paths()[p].geometry;
        SurfacePath result;
        result.a = fine_vertex_[path.a];
        result.b = fine_vertex_[path.b];
        for (std::size_t i = 0; i < steps[p].size(); ++i) {
            const Step& step = steps[p][i];
            if (step.face == invalid_index) {
                const PathSide along = base_.geometry({step.along}).front();
                for (std::size_t k = 0; k < along.node_count(); ++k)
                    result.nodes.push_back(along.node(fine, k));
            } else {
                const auto& nodes = (*drawn[step.face])[step.chord];
                result.nodes.insert(result.nodes.end(), nodes.begin(), nodes.end());
            }
            if (i + 1 < steps[p].size() && path.nodes[i].is_vertex()) {
                PathNode node;
                node.vertex = fine_vertex_[path.nodes[i].vertex];
                result.nodes.push_back(node);
            }
        }
        reduce(fine, result);
        lifted.add_path(std::move(result));
    }
    for (const PatchComplex::Face& face : complex.faces())
        lifted.add_face(face.sides);
    return lifted;
}

} // namespace bot2nurbs
