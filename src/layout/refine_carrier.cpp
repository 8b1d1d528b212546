// SPDX-License-Identifier: MIT
#include "layout/refine_carrier.h"

#include <algorithm>
#include <queue>
#include <tuple>

namespace bot2nurbs {

namespace {

// A mesh while its edges are split: faces in place, twins kept.
class Refiner {
public:
    Refiner(const ManifoldMesh& source, std::vector<double> limit, std::vector<char>& marks)
        : source_(source), positions_(source.positions()), triangles_(source.triangles()),
          limit_(std::move(limit)), marks_(marks)
    {
        for (Index h = 0; h < source.halfedge_count(); ++h)
            twin_.push_back(source.twin(h));
        carrier_ = CarrierMesh::from_source(source);
    }

    CarrierMesh run(std::size_t max_splits)
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
            split(h);
            ++splits;
        }
        if (splits > 0) {
            carrier_.refined = true;
            auto mesh = ManifoldMesh::build(std::move(positions_), std::move(triangles_));
            carrier_.mesh = std::move(*mesh); // Splitting edges of a manifold leaves a manifold.
        }
        return std::move(carrier_);
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

    void split(Index h)
    {
        const Index t = twin_[h], a = from(h), b = to(h);
        const Index m = static_cast<Index>(positions_.size());
        const Index face = carrier_.face_source[h / 3];
        const auto wa = carrier_.weights(source_, a, face);
        const auto wb = carrier_.weights(source_, b, face);
        SourcePoint p{face, {}};
        for (int k = 0; k < 3; ++k)
            p.bary[k] = 0.5 * (wa[k] + wb[k]);
        carrier_.vertex_source.push_back(p);
        positions_.push_back(source_.at(p));
        limit_.push_back(0.5 * (limit_[a] + limit_[b]));
        const Index mb = split_face(h, m);
        if (t != invalid_index) {
            const Index ma = split_face(t, m); // t runs b m now, ma runs m a.
            join(h, ma);
            join(t, mb);
            push(t);
            push(next(t));
        } else {
            twin_[h] = twin_[mb] = invalid_index;
        }
        push(h);
        push(next(h));
    }

    const ManifoldMesh& source_;
    std::vector<Vec3> positions_;
    std::vector<std::array<Index, 3>> triangles_;
    std::vector<double> limit_;
    std::vector<char>& marks_; // Per halfedge.
    std::vector<Index> twin_;
    CarrierMesh carrier_;
    std::priority_queue<std::tuple<double, Index, Index, Index>> queue_;
};

} // namespace

CarrierMesh refine_carrier(const ManifoldMesh& source, const std::vector<double>& limit,
                           std::size_t max_splits, std::vector<char>& marks)
{
    return Refiner(source, limit, marks).run(max_splits);
}

} // namespace bot2nurbs
