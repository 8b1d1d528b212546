// SPDX-License-Identifier: MIT
#pragma once

//! Cells of the two surfaces of a Hausdorff distance, and what is found out about one.

#include "bot2nurbs/hausdorff_bound.h"
#include "brep/cover_targets.h"
#include "brep/cover_walk.h"
#include "brep/distance_floor.h"
#include "fit/surface_locator.h"

#include <array>

namespace bot2nurbs {

//! Which surface a cell or place is on. The distance is that to the other one.
enum class HausdorffSide : std::uint8_t {
    surface, //!< Elements are Bezier pieces, parameters in the unit square.
    source,  //!< Elements are faces, a point is corner 0 + x (corner 1 - 0) + y (corner 2 - 0).
};

//! A part of an element. Parameters are sums of powers of two not below 2^-level, so exact.
struct HausdorffCell {
    HausdorffSide side = HausdorffSide::surface;
    std::uint8_t level = 0; //!< How often it was halved; in four is twice.
    Index element = invalid_index;
    //! Of a triangle, counter-clockwise; of a square the lowest and the highest corner.
    std::array<Vec2, 3> corner;
    Index near = invalid_index; //!< An element of the other surface near the cell,
    Vec2 near_at;               //!< and where on it, if it is a piece.
    PatchBounds bounds;         //!< Of the distance of its points from the other surface.

    //! Smaller cells would be rounding.
    static constexpr int most_levels = 48;

    static HausdorffCell whole(HausdorffSide side, Index element);
    //! Four parts of the same shape.
    std::array<HausdorffCell, 4> quarters() const;
    //! A triangle as two, cut from the middle of the side after corner k to the corner opposite.
    std::array<HausdorffCell, 2> halves(std::size_t k) const;
    //! The corners in parameters, counter-clockwise. \return how many there are.
    int corners(std::array<Vec2, 4>& at) const;
};

//! A place with its distance from the other surface, as far as a search found it.
struct FoundPlace {
    HausdorffSide side = HausdorffSide::surface;
    Index element = invalid_index;
    Vec2 at;
    double distance = -1.0;      //!< Not below the true one. Negative: no place.
    Index near = invalid_index;  //!< The element of the nearest place found,
    Vec2 near_at;                //!< where on it, if it is a piece,
    Index patch = invalid_index; //!< and the patch, of that place or of this one.
};

struct CellFindings {
    HausdorffCell cell;               //!< With its bounds.
    std::array<FoundPlace, 2> places; //!< One in the cell, and its worst one if it was looked at.
    int queries = 0;
};

//! Both surfaces, moved and scaled so that no coordinate is above one, with what is needed to
//! search them. Lengths are in that scale. Constant, so any number of threads may use it.
class HausdorffSubject {
public:
    //! `complex` and the topology of `source` must outlive it. It must not be used when `context`
    //! was cancelled meanwhile.
    HausdorffSubject(const ManifoldMesh& source, const QuadComplex& complex,
                     const SplineSurface& surface, const Context& context);
    HausdorffSubject(const HausdorffSubject&) = delete;
    HausdorffSubject& operator=(const HausdorffSubject&) = delete;

    Index piece_count() const { return pieces_.count(); }
    double from_unit(double length) const { return length / scale_; }
    double to_unit(double length) const { return length * scale_; }

    //! A place and what is nearest to it. `near`: an element that may be close, or none. The search
    //! on the surface is local and can miss a nearer place; where it ends farther away than
    //! `doubtful`, a slower one makes sure.
    FoundPlace find(HausdorffSide side, Index element, const Vec2& at, Index near,
                    double doubtful) const;
    //! Adds the parts that take the place of a cell: quarters, but halves of a thin triangle that
    //! is longer than Bezier pieces are wide. Its quarters would be as thin, and it would take
    //! hundreds until each has few pieces to be compared with.
    void split(const HausdorffCell& cell, std::vector<HausdorffCell>& parts) const;
    //! Bounds a cell. `target`: bounds up to it need not be better. `lower`: of the Hausdorff
    //! distance; only places that may be beyond it are searched for. `known`: a place in the cell,
    //! if one was found before.
    CellFindings look_at(HausdorffCell cell, const FoundPlace* known, double target,
                         double lower) const;
    //! At most the distance of a place from the other surface, and at least (1 - share) times that.
    double floor(const FoundPlace& place, double share) const;
    //! In the coordinates and units of the input.
    FarPlace far_place(const FoundPlace& place, double distance) const;

    //! A place, in that scale.
    Vec3 point(HausdorffSide side, Index element, const Vec2& at) const;

private:
    Cover cover_cell(const HausdorffCell& cell, double target) const;
    double radius(const HausdorffCell& cell, const Vec2& at) const;

    Vec3 centre_;
    double scale_; //!< A power of two.
    PlacedMesh mesh_;
    SplineSurface surface_;
    BezierPieces pieces_;
    ClosestPoint tree_;
    SurfaceLocator locator_;
    DistanceFloor floor_;
    double piece_width_; //!< Of a Bezier piece, on average.
};

//! The middle of a cell.
Vec2 middle_of(const HausdorffCell& cell);

} // namespace bot2nurbs
