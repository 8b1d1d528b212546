// SPDX-License-Identifier: MIT
#pragma once

//! Branch and bound over the cells of both sides of a Hausdorff distance.

#include "bot2nurbs/hausdorff_bound.h"
#include "brep/hausdorff_cells.h"

#include <array>
#include <optional>
#include <queue>
#include <vector>

namespace bot2nurbs {

//! The largest bound first; equal ones in the order of their cells.
struct CellOrder {
    bool operator()(const HausdorffCell& a, const HausdorffCell& b) const;
};

//! Places are found and proven until no cell can have one that is much farther. What is proven sets
//! the target that cells are bounded to, and cells within the target are closed for good, as it
//! never falls. Cells are looked at in batches, in parallel; what is learnt is merged in their
//! order.
class HausdorffSearch {
public:
    HausdorffSearch(const ManifoldMesh& source, const QuadComplex& complex,
                    const SplineSurface& surface, const HausdorffOptions& options,
                    Context& context);
    //! \return false when cancelled.
    bool run();
    HausdorffBound result() const;

private:
    //! What is known of one patch, seen from one side.
    struct PatchState {
        FoundPlace farthest;  //!< Of those found.
        double beyond = -1.0; //!< Places must be farther to replace it.
        bool proven = true;   //!< `lower` takes account of it.
        double lower = 0.0;   //!< The largest proven distance.
        double upper = 0.0;   //!< Of the cells that are closed.
    };

    //! Cells with bounds up to this are done.
    double target() const;
    //! Places nearer than this tell nothing new.
    double interesting() const { return decide_ ? *decide_ : lower_; }
    bool closed(const HausdorffCell& cell) const;
    PatchState& state(HausdorffSide side, Index patch)
    {
        return states_[static_cast<int>(side)][patch];
    }
    const PatchState& state(HausdorffSide side, Index patch) const
    {
        return states_[static_cast<int>(side)][patch];
    }
    void offer(const FoundPlace& place);
    void close(const HausdorffCell& cell);
    bool prove(const std::vector<PatchState*>& which);
    bool raise_lower();
    bool find_places();
    bool look_at(const std::vector<HausdorffCell>& cells, const std::vector<FoundPlace>& known);
    bool bound_elements();
    bool refine();

    const ManifoldMesh& source_;
    Context& context_;
    HausdorffSubject subject_;
    double relative_gap_, absolute_gap_, tie_;
    std::optional<double> decide_;
    std::uint64_t max_cells_;
    std::array<std::vector<PatchState>, 2> states_;
    std::vector<FoundPlace> piece_places_, vertex_places_;
    std::priority_queue<HausdorffCell, std::vector<HausdorffCell>, CellOrder> open_;
    std::array<FoundPlace, 2> worst_; //!< By side, with the proven distance in
    std::array<double, 2> proven_{};
    double lower_ = 0.0; //!< The larger of those.
    HausdorffTermination termination_ = HausdorffTermination::gap_reached;
    std::uint64_t cells_ = 0, queries_ = 0;
};

} // namespace bot2nurbs
