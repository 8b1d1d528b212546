// SPDX-License-Identifier: MIT
#include "bot2nurbs/clean_points.h"

#include "cloud/key_sort.h"
#include "cloud/local_scale.h"
#include "cloud/plane_fit.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace bot2nurbs {

namespace {

//! A component of the surface with fewer points near it is taken for an accident, so that fewer
//! points in all show none.
constexpr Index fewest_points = 30;
//! Points lie on a line if their second extent is this share of the first: rounding of coordinates
//! to single precision leaves less.
constexpr double line_share = 1e-6;

constexpr int hash_bits = 63;

//! Depends on the place alone; the two zeros are the same.
std::uint64_t hash_of(const Vec3& p)
{
    std::uint64_t hash = 14695981039346656037u;
    for (int k = 0; k < 3; ++k) {
        const double x = p[k] + 0.0;
        std::uint64_t bits = 0;
        std::memcpy(&bits, &x, sizeof bits);
        hash = (hash ^ bits) * 1099511628211u;
        hash ^= hash >> 29;
    }
    return hash >> (64 - hash_bits);
}

//! Per point of `positions` the first one at the same place.
bool find_first_at_place(const std::vector<Vec3>& positions, std::vector<Index>& first,
                         const Context& context)
{
    std::vector<KeyedSlot> items(positions.size());
    for (Index i = 0; i < positions.size(); ++i)
        items[i] = {hash_of(positions[i]), i};
    if (!sort_keys(items, hash_bits, context))
        return false;
    first.resize(positions.size());
    std::vector<Index> places; // that have the hash at hand, first points first
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (i == 0 || items[i].key != items[i - 1].key)
            places.clear();
        const Index point = items[i].slot;
        const auto same = std::find_if(places.begin(), places.end(),
                                       [&](Index p) { return positions[p] == positions[point]; });
        first[point] = same != places.end() ? *same : point;
        if (same == places.end())
            places.push_back(point);
    }
    return true;
}

std::optional<Error> refuse_shape(const CleanPoints& points, std::size_t all)
{
    const std::size_t n = points.positions.size();
    if (n < fewest_points)
        return Error{ErrorCode::bad_geometry,
                     std::to_string(n) + " of " + std::to_string(all) +
                         " points are finite and differ: too few to show a surface, at least " +
                         std::to_string(fewest_points) + " are needed",
                     invalid_index};
    std::vector<PointTree::Neighbor> everything(n);
    for (Index i = 0; i < n; ++i)
        everything[i].point = i;
    const PlaneFit plane = fit_plane(points.positions, everything.data(), n);
    if (!(plane.variances[1] > line_share * line_share * plane.variances[2]))
        return Error{ErrorCode::bad_geometry, "all points lie on a line: they show no surface",
                     points.source[0]};
    return std::nullopt;
}

//! The confidences of the file, of any scale, in 0 .. 1.
void scale_confidence(std::vector<double>& confidence)
{
    for (double& c : confidence)
        c = c > 0.0 && std::isfinite(c) ? c : 0.0;
    const double median = median_of(confidence);
    for (double& c : confidence)
        c = median > 0.0 ? std::min(c / median, 1.0) : 1.0;
}

} // namespace

Result<CleanPoints> clean_points(const PointCloud& cloud, Context& context)
{
    CleanPoints clean;
    std::vector<Vec3> finite;
    std::vector<Index> number;
    for (Index i = 0; i < cloud.size(); ++i) {
        if (!is_finite(cloud.positions[i])) {
            ++clean.not_finite;
            continue;
        }
        finite.push_back(cloud.positions[i]);
        number.push_back(i);
    }
    std::vector<Index> first;
    if (!find_first_at_place(finite, first, context))
        return Context::cancelled_error("cleaning of points");

    const bool normals = !cloud.normals.empty(), confidence = !cloud.confidence.empty();
    std::vector<Index> place(finite.size()); // in the result, of points that are first
    for (Index i = 0; i < finite.size(); ++i) {
        if (first[i] == i) {
            place[i] = static_cast<Index>(clean.positions.size());
            clean.positions.push_back(finite[i]);
            clean.source.push_back(number[i]);
            if (normals)
                clean.normals.emplace_back();
            if (confidence)
                clean.confidence.push_back(0.0);
        } else {
            ++clean.duplicates;
        }
        const Index at = place[first[i]];
        if (normals && is_finite(cloud.normals[number[i]]))
            clean.normals[at] += normalized(cloud.normals[number[i]]);
        if (confidence)
            clean.confidence[at] = std::max(clean.confidence[at], cloud.confidence[number[i]]);
    }
    if (std::optional<Error> refused = refuse_shape(clean, cloud.size()))
        return *refused;
    for (Vec3& n : clean.normals)
        n = normalized(n);
    clean.without_normal =
        static_cast<Index>(std::count(clean.normals.begin(), clean.normals.end(), Vec3{}));
    if (clean.without_normal == clean.positions.size()) {
        clean.normals.clear();
        clean.without_normal = 0;
    }
    if (confidence)
        scale_confidence(clean.confidence);
    return clean;
}

} // namespace bot2nurbs
