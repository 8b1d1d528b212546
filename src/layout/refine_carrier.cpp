// SPDX-License-Identifier: MIT
#include "layout/refine_carrier.h"

#include "core/predicates.h"

#include <algorithm>
#include <map>
#include <queue>
#include <tuple>

namespace bot2nurbs {

namespace {

// A mesh while its edges are split: faces in place, twins kept.
class Refiner {
public:
    Refiner(const ManifoldMesh& source, std::vector<double> limit, std::vector<char> marks)
        : source_(source), positions_(source.positions()), triangles_(source.triangles()),
          limit_(std::move(limit)), marks_(std::move(marks))
    {
        for (Index h = 0; h < source.halfedge_count(); ++h)
            twin_.push_back(source.twin(h));
        carrier_ = CarrierMesh::from_source(source);
    }

    // Makes a point a vertex: a corner of its face, in an edge, or inside a face.
    Index insert(const SourcePoint& point)
    {
        auto& pieces = pieces_[point.face];
        if (pieces.empty())
            pieces.push_back(point.face);
        const Vec2 p{point.bary[0], point.bary[1]};
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const Index f = pieces[i];
            int side[3];
            for (Index k = 0; k < 3; ++k)
                side[k] =
                    orient2d(place(3 * f + k, point.face), place(next(3 * f + k), point.face), p);
            if (std::min({side[0], side[1], side[2]}) < 0)
                continue;
            const auto on = std::count(side, side + 3, 0);
            for (Index k = 0; k < 3; ++k) {
                // On two sides: their common corner. On one: in that edge.
                if (on >= 2 && side[k] == 0 && side[(k + 2) % 3] == 0)
                    return from(3 * f + k);
                if (on == 1 && side[k] == 0)
                    return split(3 * f + k, point);
            }
            return split_inside(f, point);
        }
        return invalid_index;
    }

    PlannedCarrier run(std::size_t max_splits)
    {
        for (Index h = 0; h < twin_.size(); ++h)
            if (h < twin_[h])
                push(h);
        std::size_t splits = 0;
        while (!queue_.empty() && splits < max_splits) {
            const auto [ratio, a, b, h] = queue_.top();
            queue_.pop();
            // Stale when the halfedge has been split since.
            if (from(h) != a || to(h) != b)
                continue;
            split(h, middle(h));
            ++splits;
        }
        if (positions_.size() > source_.vertex_count()) {
            carrier_.refined = true;
            auto mesh = ManifoldMesh::build(std::move(positions_), std::move(triangles_));
            carrier_.mesh = std::move(*mesh); // Splitting edges of a manifold leaves a manifold.
        }
        return {std::move(carrier_), std::move(marks_), {}};
    }

private:
    static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static Index prev(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
    Index from(Index h) const { return triangles_[h / 3][h % 3]; }
    Index to(Index h) const { return from(next(h)); }

    void push(Index h)
    {
        const Index a = from(h), b = to(h);
        const double ratio = norm(positions_[a] - positions_[b]) / std::min(limit_[a], limit_[b]);
        if (ratio > 1.0)
            queue_.emplace(ratio, a, b, h);
    }
    void join(Index g, Index h)
    {
        twin_[g] = h;
        if (h != invalid_index)
            twin_[h] = g;
    }
    // Splits one side: face (a, b, c) of halfedge a b becomes (a, m, c), a new face is (m, b, c).
    // Returns the halfedge m b.
    Index split_face(Index h, Index m)
    {
        const Index f = h / 3, b = to(h), c = from(prev(h));
        const Index bc = next(h), outer = twin_[bc];
        const Index added = static_cast<Index>(triangles_.size());
        triangles_[f][next(h) % 3] = m;
        triangles_.push_back({m, b, c});
        carrier_.face_source.push_back(carrier_.face_source[f]);
        twin_.resize(twin_.size() + 3, invalid_index);
        marks_.insert(marks_.end(), {marks_[h], marks_[bc], 0});
        marks_[bc] = 0;
        join(3 * added + 1, outer);
        push(3 * added + 1);     // Its entry in the queue names bc.
        join(bc, 3 * added + 2); // bc now runs from m to c.
        return 3 * added;
    }

    SourcePoint middle(Index h) const
    {
        const Index face = carrier_.face_source[h / 3];
        const auto wa = carrier_.weights(source_, from(h), face);
        const auto wb = carrier_.weights(source_, to(h), face);
        SourcePoint p{face, {}};
        for (int k = 0; k < 3; ++k)
            p.bary[k] = 0.5 * (wa[k] + wb[k]);
        return p;
    }
    // First two weights of a halfedge's start in a source face.
    Vec2 place(Index h, Index face) const
    {
        const auto w = carrier_.weights(source_, from(h), face);
        return {w[0], w[1]};
    }
    Index add_vertex(const SourcePoint& p, double limit)
    {
        carrier_.vertex_source.push_back(p);
        positions_.push_back(source_.at(p));
        limit_.push_back(limit);
        return static_cast<Index>(positions_.size() - 1);
    }
    // The face of the new vertex's star that lies in a source face, for points that follow.
    void note_piece(Index face)
    {
        const auto found = pieces_.find(carrier_.face_source[face]);
        if (found != pieces_.end())
            found->second.push_back(face);
    }

    // Splits an edge at a point on it.
    Index split(Index h, const SourcePoint& p)
    {
        const Index t = twin_[h], a = from(h), b = to(h);
        const Index m = add_vertex(p, 0.5 * (limit_[a] + limit_[b]));
        // Pieces of the face across are looked up from now on: it is whole no more.
        if (t != invalid_index && !pieces_.empty())
            pieces_.try_emplace(carrier_.face_source[t / 3], 1, t / 3);
        const Index mb = split_face(h, m);
        note_piece(mb / 3);
        if (t != invalid_index) {
            const Index ma = split_face(t, m); // t runs b m now, ma runs m a.
            note_piece(ma / 3);
            join(h, ma);
            join(t, mb);
            push(t);
            push(next(t));
        } else {
            twin_[h] = twin_[mb] = invalid_index;
        }
        push(h);
        push(next(h));
        return m;
    }
    // Splits a face (a, b, c) at a point inside it in (a, b, m), (b, c, m), (c, a, m).
    Index split_inside(Index f, const SourcePoint& p)
    {
        const std::array<Index, 3> c = triangles_[f];
        const Index m = add_vertex(p, (limit_[c[0]] + limit_[c[1]] + limit_[c[2]]) / 3.0);
        const Index outer[3] = {twin_[3 * f], twin_[3 * f + 1], twin_[3 * f + 2]};
        const char mark[3] = {marks_[3 * f], marks_[3 * f + 1], marks_[3 * f + 2]};
        const Index first = static_cast<Index>(triangles_.size());
        const Index piece[3] = {f, first, first + 1};
        triangles_[f] = {c[0], c[1], m};
        for (int k = 1; k < 3; ++k) {
            triangles_.push_back({c[k], c[(k + 1) % 3], m});
            carrier_.face_source.push_back(carrier_.face_source[f]);
            note_piece(piece[k]);
        }
        twin_.resize(3 * triangles_.size(), invalid_index);
        marks_.resize(3 * triangles_.size(), 0);
        for (int k = 0; k < 3; ++k) {
            join(3 * piece[k], outer[k]);
            join(3 * piece[k] + 1, 3 * piece[(k + 1) % 3] + 2);
            marks_[3 * piece[k]] = mark[k];
            marks_[3 * piece[k] + 1] = marks_[3 * piece[k] + 2] = 0;
        }
        return m;
    }

    const ManifoldMesh& source_;
    std::vector<Vec3> positions_;
    std::vector<std::array<Index, 3>> triangles_;
    std::vector<double> limit_;
    std::vector<char> marks_; // Per halfedge.
    std::vector<Index> twin_;
    CarrierMesh carrier_;
    std::map<Index, std::vector<Index>> pieces_; // Of source faces that points were inserted in.
    std::priority_queue<std::tuple<double, Index, Index, Index>> queue_;
};

} // namespace

PlannedCarrier refine_carrier(const ManifoldMesh& source, CarrierPlan plan)
{
    Refiner refiner(source, std::move(plan.limit), std::move(plan.marks));
    std::vector<Index> vertices;
    for (const SourcePoint& p : plan.points)
        vertices.push_back(refiner.insert(p));
    PlannedCarrier result = refiner.run(plan.max_splits);
    result.point_vertices = std::move(vertices);
    return result;
}

} // namespace bot2nurbs
