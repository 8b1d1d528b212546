// SPDX-License-Identifier: MIT
#pragma once

//! A bound of the distance from a cell of one surface to another surface: the cell is cut along the
//! borders of the other surface's elements it lies over, and every part is bounded against one
//! element. Both directions of the Hausdorff distance walk this way.

#include "bot2nurbs/result.h"
#include "bot2nurbs/vec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace bot2nurbs {

struct CoverVertex {
    Vec2 at;      //!< On the surface that is covered, in the parameters of the cell's element.
    Vec3 point;   //!< There.
    Vec3 partner; //!< A point near it on the element of the other surface.
    Vec2 foot;    //!< Parameters of the partner, where the other surface is the spline.
    Vec2 beyond;  //!< As PieceFoot::beyond.
};

//! A convex polygon in parameters.
struct CoverPolygon {
    //! A cell has three or four corners and a cut adds one at most; polygons that would get more
    //! are not cut.
    static constexpr int capacity = 12;
    std::array<CoverVertex, capacity> vertex;
    int size = 0;

    void add(const CoverVertex& v) { vertex[size++] = v; }
};

//! Upper bounds by patch. A cell lies over few patches; a walk does not enter one more.
struct PatchBounds {
    static constexpr int capacity = 4;
    struct Entry {
        Index patch = invalid_index;
        double bound = 0.0;
    };
    std::array<Entry, capacity> entry;
    int size = 0;

    bool has_room_for(Index patch) const { return size < capacity || find(patch) < size; }
    //! \pre has_room_for(patch)
    void add(Index patch, double bound)
    {
        const int i = find(patch);
        if (i == size)
            entry[size++] = {patch, bound};
        else if (!(bound <= entry[i].bound)) // a NaN must not get lost
            entry[i].bound = bound;
    }
    //! Adds a length to all bounds.
    void raise(double by)
    {
        for (int i = 0; i < size; ++i)
            entry[i].bound += by;
    }
    double max() const
    {
        double largest = 0.0;
        for (int i = 0; i < size; ++i)
            largest = entry[i].bound <= largest ? largest : entry[i].bound;
        return largest;
    }

private:
    int find(Index patch) const
    {
        int i = 0;
        while (i < size && entry[i].patch != patch)
            ++i;
        return i;
    }
};

//! What is known of a polygon against one element.
struct PartBound {
    double bound = 0.0;  //!< Of the distance of its places from the element.
    Vec2 worst;          //!< Where that is about largest,
    double length = 0.0; //!< and how large.
};

struct Cover {
    PatchBounds bounds;
    PartBound worst; //!< Of the worst part.
};

//! Parts a cell is cut into at most before the rest is bounded as it is; the cell is split if that
//! does not do. Cut lines run on behind the element they come from, so the number of parts grows
//! faster than that of the elements; smaller cells are cheaper than more parts.
inline constexpr int most_parts = 32;
//! A part that reaches beyond its element by this share of the target is left whole: the distance
//! grows by less than a tenth of a percent.
inline constexpr double harmless_excess = 0.03;

//! Cuts a polygon by the sign of a length given at its vertices. The two parts cover it whatever
//! the signs: with one run of positive vertices they meet in a chord, with more they overlap.
//! `between(a, b, t)` makes the vertex at a + t (b - a). \return false when a part would have too
//! many vertices.
template <class Between>
bool split(const CoverPolygon& polygon, const std::array<double, CoverPolygon::capacity>& excess,
           const Between& between, CoverPolygon& inside, CoverPolygon& outside)
{
    const int n = polygon.size;
    const auto next = [n](int i) { return i + 1 < n ? i + 1 : 0; };
    int positive = 0, crossings = 0;
    for (int i = 0; i < n; ++i) {
        positive += excess[i] > 0.0;
        crossings += (excess[i] > 0.0) != (excess[next(i)] > 0.0);
    }
    if (crossings + positive > CoverPolygon::capacity ||
        crossings + n - positive > CoverPolygon::capacity)
        return false;
    for (int i = 0; i < n; ++i) {
        const int j = next(i);
        (excess[i] > 0.0 ? outside : inside).add(polygon.vertex[i]);
        if ((excess[i] > 0.0) == (excess[j] > 0.0))
            continue;
        const CoverVertex v =
            between(polygon.vertex[i], polygon.vertex[j], excess[i] / (excess[i] - excess[j]));
        inside.add(v);
        outside.add(v);
    }
    return true;
}

//! Bounds the distance of `cell` from the other surface. `target`: parts within it are not refined.
//!
//! Other has, for a place on the other surface (an element, and the side it was entered through):
//!   Place;
//!   void attach(const Place&, CoverVertex&)       finds the vertex's partner;
//!   void enter(const Place&, CoverVertex&)        makes ready for that what comes from next door;
//!   PartBound bound(const Place&, const CoverPolygon&)  by the lemma of residual_bound.h;
//!   Index patch(const Place&)                     that the part counts for;
//!   std::optional<Cut> cut(const Place&, int k)   what leads over side k < sides, if anything, as
//!     Cut::next and Cut::excess(vertex), the length by which a vertex is beyond the side;
//!   CoverVertex between(const CoverVertex&, const CoverVertex&, double t), not attached.
template <class Other> Cover cover(const Other& other, const CoverPolygon& cell,
                                   const typename Other::Place& start, double target)
{
    struct Part {
        CoverPolygon polygon;
        typename Other::Place place;
        bool entered;
    };
    Cover out;
    std::vector<Part> open{{cell, start, false}};
    out.bounds.add(other.patch(start), 0.0);
    int parts = 1;
    while (!open.empty()) {
        Part part = open.back();
        open.pop_back();
        CoverPolygon& polygon = part.polygon;
        for (int i = 0; i < polygon.size; ++i) {
            if (part.entered)
                other.enter(part.place, polygon.vertex[i]);
            other.attach(part.place, polygon.vertex[i]);
        }
        PartBound bound = other.bound(part.place, polygon);
        bool gone = false, cut_off = false;
        for (int k = 0; k < Other::sides && !(bound.bound <= target) && !gone && parts < most_parts;
             ++k) {
            const auto cut = other.cut(part.place, k);
            if (!cut || !out.bounds.has_room_for(other.patch(cut->next)))
                continue;
            std::array<double, CoverPolygon::capacity> excess;
            double most = -INFINITY, least = INFINITY;
            for (int i = 0; i < polygon.size; ++i) {
                excess[i] = cut->excess(polygon.vertex[i]);
                most = std::max(most, excess[i]);
                least = std::min(least, excess[i]);
            }
            if (!(most > harmless_excess * target))
                continue;
            if (least > 0.0) {
                open.push_back({polygon, cut->next, true});
                gone = true;
            } else {
                CoverPolygon inside, outside;
                if (!split(
                        polygon, excess,
                        [&](const CoverVertex& a, const CoverVertex& b, double t) {
                            CoverVertex v = other.between(a, b, t);
                            other.attach(part.place, v);
                            return v;
                        },
                        inside, outside))
                    continue;
                open.push_back({outside, cut->next, true});
                polygon = inside;
                cut_off = true;
            }
            out.bounds.add(other.patch(cut->next), 0.0);
            ++parts;
        }
        if (gone)
            continue;
        if (cut_off)
            bound = other.bound(part.place, polygon);
        out.bounds.add(other.patch(part.place), bound.bound);
        if (!(bound.bound <= out.worst.bound))
            out.worst = bound;
    }
    return out;
}

} // namespace bot2nurbs
