// SPDX-License-Identifier: MIT
#pragma once

#include "layout/patch_complex.h"

#include <algorithm>
#include <map>
#include <vector>

namespace bot2nurbs {

//! Number of edges at each vertex of K_tri or K while it is improved, and what numbers other than
//! the wanted one cost. Wanted are six edges inside K_tri and four inside K; at the boundary as
//! many faces as the angle of the mesh there asks for, of 60 and of 90 degrees.
class Valences {
public:
    //! `sides` of every face: 3 or 4.
    Valences(const PatchComplex& complex, Index sides);

    int operator[](Index vertex) const { return count_[vertex]; }
    void add(Index vertex, int change) { count_[vertex] += change; }
    //! A vertex takes another's place.
    void move(Index from, Index to);

    //! What `edges` edges at a vertex cost, in units of the energy of a patch of the wanted size.
    double cost(Index vertex, int edges) const;
    //! How many edges more than wanted a vertex has.
    double excess(Index vertex) const
    {
        return static_cast<double>(count_[vertex]) - wanted(vertex);
    }
    //! By how much the cost changes with the number of edges.
    double change(Index vertex, int by) const
    {
        return cost(vertex, count_[vertex] + by) - cost(vertex, count_[vertex]);
    }
    //! Whether a vertex may get, or lose, an edge: the masks of the splines grow fast with valence,
    //! and below the least number there are none.
    bool may_gain(Index vertex, int by = 1) const { return count_[vertex] + by <= most_; }
    bool may_lose(Index vertex) const { return count_[vertex] > least(vertex); }
    //! Vertices of K (`by` more edges counted in) that must get another edge or go: those inside
    //! with two edges, where the splines do not exist, and those of the boundary with a corner that
    //! is nearly flat or more, where a patch has no tangent plane.
    bool is_degenerate(Index vertex, int by = 0) const;
    bool is_inside(Index vertex) const { return angle_[vertex] == 0.0; }

private:
    double wanted(Index vertex) const
    {
        const double inside = sides_ == 3 ? 6.0 : 4.0;
        const auto asked = asked_.find(vertex);
        if (asked != asked_.end())
            return asked->second * inside / 4.0;
        return angle_[vertex] > 0.0 ? 1.0 + std::max(1.0, angle_[vertex]) : inside;
    }
    int least(Index vertex) const
    {
        const int inside = sides_ == 3 ? 3 : 2;
        return angle_[vertex] > 0.0 ? 2 : inside;
    }

    Index sides_;
    std::map<Index, Index> asked_; // Quads wanted at single vertices.
    int most_;
    std::vector<int> count_;    // Per mesh vertex.
    std::vector<double> angle_; // Per mesh vertex: at the boundary, in units of a face's; else 0.
};

} // namespace bot2nurbs
