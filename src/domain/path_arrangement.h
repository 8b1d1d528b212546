// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"
#include "domain/validate_domain_rules.h"

#include <vector>

namespace bot2nurbs {

//! The paths of a domain as cuts of the faces of its carrier, with all orders decided exactly.
class PathArrangement {
public:
    //! Reads the paths and adds defects of the rules path_point, path_step and path_crossing.
    //! \pre indices are right.
    PathArrangement(const QuadDomain& domain, DefectList& defects);

    //! Rule vertex_order. \pre no defects so far.
    void check_vertex_order(DefectList& defects) const;
    //! Rule boundary. \pre no defects so far.
    void check_boundary(DefectList& defects) const;
    //! Rule region. \pre no defects so far, those of the two rules above included.
    void check_regions(DefectList& defects) const;

private:
    //! A point of a path: a carrier vertex, or a crossing of a carrier edge.
    struct Node {
        Index vertex = invalid_index;
        Index halfedge = invalid_index; //!< Crossing: its edge's name.
        double t = 0.0;
        bool reversed = false; //!< t counts from the end of `halfedge`.
        Index rank = 0;        //!< Number of crossings of the edge before this one.

        bool is_vertex() const { return vertex != invalid_index; }
    };
    //! A stretch of a path between two points: along a carrier edge, or across a carrier face.
    struct Step {
        Index edge = invalid_index; //!< Of the domain.
        Index face = invalid_index; //!< Across this face; invalid: along `halfedge`.
        Index halfedge = invalid_index;
        bool reversed = false; //!< Along `halfedge` from its end to its start.
        //! Across: where on the face's border the step starts and ends.
        std::array<Index, 2> from{}, to{};
    };
    //! A cut of a face, its ends in the order of the face's border: {slot, rank} with slot 2 k for
    //! corner k and 2 k + 1 for side k.
    struct Chord {
        std::array<Index, 2> low, high;
        Index step;
    };

    //! Exact order of two crossings of one edge: -1, 0, 1.
    static int compare(const Node& a, const Node& b);
    static bool chord_before(const Chord& a, const Chord& b);

    bool read_nodes(Index e, DefectList& defects);
    bool read_steps(Index e, DefectList& defects);
    bool make_step(const Node& a, const Node& b, Step& step) const;
    bool touches(const Node& node, Index face) const;
    void rank_crossings(DefectList& defects);
    void check_vertices_and_runs(DefectList& defects) const;
    void set_positions();
    void sort_chords(DefectList& defects);
    std::array<Index, 2> position(const Node& node, Index face) const;
    //! Calls open(chord), close(chord) and interval(slot, rank) around the border of a face: the
    //! last for each stretch between neighbouring ends, which starts at this place.
    template <class Open, class Close, class Interval>
    void sweep(Index face, const Open& open, const Close& close, const Interval& interval) const;

    const QuadDomain& domain_;
    const ManifoldMesh& mesh_;
    std::vector<std::vector<Node>> nodes_; //!< Per domain edge, ends included.
    std::vector<Step> steps_;
    std::vector<Index> first_step_;  //!< Per domain edge; one more at the end.
    std::vector<Index> crossings_;   //!< Per halfedge that names an edge: their number.
    std::vector<Chord> chords_;      //!< Of face 0, of face 1, ...; sorted for sweep().
    std::vector<Index> first_chord_; //!< Per face; one more at the end.
};

template <class Open, class Close, class Interval>
void PathArrangement::sweep(Index face, const Open& open, const Close& close,
                            const Interval& interval) const
{
    std::vector<Index> stack;
    Index next = first_chord_[face];
    const auto at = [&](std::array<Index, 2> place) {
        while (!stack.empty() && chords_[stack.back()].high == place) {
            close(stack.back());
            stack.pop_back();
        }
        for (; next < first_chord_[face + 1] && chords_[next].low == place; ++next) {
            open(next);
            stack.push_back(next);
        }
        interval(place[0], place[1]);
    };
    for (Index k = 0; k < 3; ++k) {
        at({2 * k, 0});
        const Index crossings = crossings_[mesh_.edge(3 * face + k)];
        for (Index rank = 0; rank < crossings; ++rank)
            at({2 * k + 1, rank});
    }
}

} // namespace bot2nurbs
