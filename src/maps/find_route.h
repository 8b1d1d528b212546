// SPDX-License-Identifier: MIT
#pragma once

#include "maps/path_web.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace bot2nurbs {

//! A plane that a path should run along, if it can: crossings are placed where they are nearest to
//! it.
struct GuidePlane {
    Vec3 point, normal;
};

//! Finds short routes through a web of paths. Keeps scratch arrays of the size of the web, so one
//! object serves many calls.
class RouteFinder {
public:
    explicit RouteFinder(const PathWeb& web) : web_(web) {}

    //! The shortest route between two sites that leaves each within the given sector, its length
    //! that of the polyline through the places nearest to the guide plane: exact for a route along
    //! the plane. `chain`, mesh vertices from a to b joined by edges, is a way to be taken where it
    //! is open and no longer than others; it may be empty. No result when the sectors do not belong
    //! to one region of the mesh. Cost that of Dijkstra's algorithm over the stretches nearer than
    //! b (A* search).
    std::optional<PathWeb::Route> find(Index a, const PathWeb::Sector& at_a, Index b,
                                       const PathWeb::Sector& at_b, const GuidePlane& guide,
                                       const std::vector<Index>& chain);

private:
    //! Whether a path can be laid along a chain of mesh edges.
    bool is_open(const std::vector<Index>& chain, const PathWeb::Sector& at_a,
                 const PathWeb::Sector& at_b) const;
    struct Visit {
        std::uint32_t stamp = 0;
        bool done = false;
        double length = 0.0;
        PathWeb::Stretch stretch; //!< As seen from the face that is left.
        Vec3 place;
        double t = 0.0;
        Index before = invalid_index; //!< Number of the stretch before; invalid at the start.
        PathWeb::Wedge from;          //!< At the start.
    };

    const PathWeb& web_;
    std::uint32_t stamp_ = 0;
    std::vector<Visit> visits_; //!< By the number of the stretch.
};

} // namespace bot2nurbs
