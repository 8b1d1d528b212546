// SPDX-License-Identifier: MIT
#include "mesh/degenerate_faces.h"

#include <algorithm>
#include <tuple>

namespace bot2nurbs {

namespace {

// Changes allowed per degenerate face found at the start. Each change removes one or moves one on
// to a shorter side, so few are needed; the bound only makes sure that the work ends.
constexpr std::size_t changes_per_face = 20;

bool is_alive(const std::array<Index, 3>& t)
{
    return t[0] != invalid_index;
}

class Remover {
public:
    Remover(const std::vector<Vec3>& positions, double distance,
            std::vector<std::array<Index, 3>>& triangles)
        : positions_(positions), distance_(distance), triangles_(triangles)
    {
    }

    DegenerateRemoval run()
    {
        std::vector<Index> open;
        for (Index f = 0; f < triangles_.size(); ++f)
            if (is_degenerate(f))
                open.push_back(f);
        if (open.empty())
            return {};
        faces_at_.resize(positions_.size());
        for (Index f = 0; f < triangles_.size(); ++f)
            for (const Index v : triangles_[f])
                faces_at_[v].push_back(f);
        std::size_t budget = changes_per_face * open.size();
        // Rounds: what is stuck may come free when a neighbour has gone.
        for (bool changed = true; changed && budget > 0;) {
            changed = false;
            for (const Index f : open)
                while (budget > 0 && is_alive(triangles_[f]) && is_degenerate(f) && improve(f)) {
                    changed = true;
                    --budget;
                }
            open.insert(open.end(), touched_.begin(), touched_.end());
            touched_.clear();
            open.erase(std::remove_if(
                           open.begin(), open.end(),
                           [&](Index f) { return !is_alive(triangles_[f]) || !is_degenerate(f); }),
                       open.end());
            std::sort(open.begin(), open.end());
            open.erase(std::unique(open.begin(), open.end()), open.end());
        }
        result_.kept = std::move(open);
        return std::move(result_);
    }

private:
    bool is_degenerate(Index f) const
    {
        const auto& t = triangles_[f];
        return has_no_area(positions_[t[0]], positions_[t[1]], positions_[t[2]], distance_);
    }
    double length2(Index a, Index b) const { return norm_squared(positions_[a] - positions_[b]); }

    std::vector<Index> faces_with(Index a, Index b) const
    {
        std::vector<Index> faces;
        for (const Index f : faces_at_[a])
            if (has(f, b))
                faces.push_back(f);
        return faces;
    }
    bool has(Index f, Index v) const
    {
        const auto& t = triangles_[f];
        return t[0] == v || t[1] == v || t[2] == v;
    }
    //! Neighbours of a vertex, ascending.
    std::vector<Index> ring(Index v) const
    {
        std::vector<Index> around;
        for (const Index f : faces_at_[v])
            for (const Index w : triangles_[f])
                if (w != v)
                    around.push_back(w);
        std::sort(around.begin(), around.end());
        around.erase(std::unique(around.begin(), around.end()), around.end());
        return around;
    }
    bool on_boundary(Index v) const
    {
        for (const Index w : ring(v))
            if (faces_with(v, w).size() != 2)
                return true;
        return false;
    }
    void detach(Index f)
    {
        for (const Index v : triangles_[f]) {
            auto& faces = faces_at_[v];
            faces.erase(std::find(faces.begin(), faces.end(), f));
        }
        triangles_[f] = {invalid_index, invalid_index, invalid_index};
    }
    void attach(Index f, const std::array<Index, 3>& t)
    {
        triangles_[f] = t;
        for (const Index v : t)
            faces_at_[v].push_back(f);
        touched_.push_back(f);
    }

    bool improve(Index f)
    {
        const auto t = triangles_[f];
        // Sides from the shortest to the longest, by their first corner.
        std::array<int, 3> side{0, 1, 2};
        std::sort(side.begin(), side.end(), [&](int i, int j) {
            const double x = length2(t[i], t[(i + 1) % 3]), y = length2(t[j], t[(j + 1) % 3]);
            return x < y || (x == y && i < j);
        });
        for (const int i : side)
            if (length2(t[i], t[(i + 1) % 3]) <= distance_ * distance_ &&
                collapse(t[i], t[(i + 1) % 3]))
                return true;
        return flip_cap(f, t[side[2]], t[(side[2] + 1) % 3], t[(side[2] + 2) % 3]);
    }

    //! Draws the edge ab together when that leaves the surface as it is in topology: the only
    //! common neighbours are the far corners of the faces on ab, and the edge does not join two
    //! boundaries across the inside.
    bool collapse(Index a, Index b)
    {
        if (b < a)
            std::swap(a, b);
        const std::vector<Index> faces = faces_with(a, b);
        if (faces.empty() || faces.size() > 2)
            return false;
        const std::vector<Index> at_a = ring(a), at_b = ring(b);
        std::vector<Index> common;
        std::set_intersection(at_a.begin(), at_a.end(), at_b.begin(), at_b.end(),
                              std::back_inserter(common));
        if (common.size() != faces.size())
            return false;
        if (faces.size() == 2 && on_boundary(a) && on_boundary(b))
            return false;
        // A tetrahedron would become two faces back to back, a lone triangle would vanish.
        if (at_a.size() <= 3 && at_b.size() <= 3 && faces.size() == 2)
            return false;
        if (faces.size() == 1 && faces_at_[a].size() == 1 && faces_at_[b].size() == 1)
            return false;
        for (const Index f : faces)
            detach(f);
        const std::vector<Index> moved = faces_at_[b];
        for (const Index f : moved) {
            std::array<Index, 3> t = triangles_[f];
            detach(f);
            std::replace(t.begin(), t.end(), b, a);
            attach(f, t);
        }
        ++result_.collapsed_edges;
        return true;
    }

    //! The corner c of the cap abc lies on its longest side ab: the cap goes and c cuts the face
    //! behind ab in two. At a boundary the cap alone goes.
    bool flip_cap(Index f, Index a, Index b, Index c)
    {
        const std::vector<Index> faces = faces_with(a, b);
        if (faces.size() == 1) {
            // The boundary moves from ab to its other sides, unless c would become a pinch.
            const bool ac = faces_with(a, c).size() == 1, bc = faces_with(b, c).size() == 1;
            if (!ac && !bc && on_boundary(c))
                return false;
            detach(f);
            ++result_.flipped_caps;
            return true;
        }
        if (faces.size() != 2)
            return false;
        const Index g = faces[0] == f ? faces[1] : faces[0];
        const auto behind = triangles_[g];
        int k = 0;
        while (behind[k] == a || behind[k] == b)
            ++k;
        const Index d = behind[k];
        if (d == c || !faces_with(c, d).empty())
            return false;
        // Between two caps the common side must get shorter, or they could take turns for ever.
        if (is_degenerate(g) && !(length2(c, d) < length2(a, b)))
            return false;
        std::array<Index, 3> first = behind, second = behind;
        std::replace(first.begin(), first.end(), a, c);
        std::replace(second.begin(), second.end(), b, c);
        detach(f);
        detach(g);
        attach(g, first);
        attach(f, second);
        ++result_.flipped_caps;
        return true;
    }

    const std::vector<Vec3>& positions_;
    double distance_;
    std::vector<std::array<Index, 3>>& triangles_;
    std::vector<std::vector<Index>> faces_at_;
    std::vector<Index> touched_;
    DegenerateRemoval result_;
};

} // namespace

bool has_no_area(const Vec3& a, const Vec3& b, const Vec3& c, double distance)
{
    const double longest2 =
        std::max({norm_squared(b - a), norm_squared(c - b), norm_squared(a - c)});
    return !(norm(cross(b - a, c - a)) > distance * std::sqrt(longest2));
}

std::vector<Index> duplicate_faces(const std::vector<std::array<Index, 3>>& triangles)
{
    if (triangles.empty())
        return {};
    // Faces by their smallest corner, then by the two others: few share the first.
    struct Key {
        Index middle, largest, face;
        bool operator<(const Key& o) const
        {
            return std::tie(middle, largest, face) < std::tie(o.middle, o.largest, o.face);
        }
    };
    const auto smallest = [](const std::array<Index, 3>& t) {
        return std::min({t[0], t[1], t[2]});
    };
    Index last = 0;
    for (const auto& t : triangles)
        last = std::max(last, smallest(t));
    std::vector<Index> first(std::size_t{last} + 2, 0);
    for (const auto& t : triangles)
        ++first[smallest(t) + 1];
    for (Index v = 0; v <= last; ++v)
        first[v + 1] += first[v];
    std::vector<Key> keys(triangles.size());
    std::vector<Index> slot(first.begin(), first.end() - 1);
    for (Index f = 0; f < triangles.size(); ++f) {
        std::array<Index, 3> t = triangles[f];
        std::sort(t.begin(), t.end());
        keys[slot[t[0]]++] = {t[1], t[2], f};
    }
    std::vector<Index> copies;
    for (Index v = 0; v <= last; ++v) {
        std::sort(keys.begin() + first[v], keys.begin() + first[v + 1]);
        for (Index i = first[v] + 1; i < first[v + 1]; ++i)
            if (keys[i].middle == keys[i - 1].middle && keys[i].largest == keys[i - 1].largest)
                copies.push_back(keys[i].face);
    }
    std::sort(copies.begin(), copies.end());
    return copies;
}

DegenerateRemoval remove_degenerate_faces(const std::vector<Vec3>& positions, double distance,
                                          std::vector<std::array<Index, 3>>& triangles)
{
    return Remover(positions, distance, triangles).run();
}

} // namespace bot2nurbs
