// SPDX-License-Identifier: MIT
#include "bot2nurbs/hausdorff_bound.h"

#include "brep/hausdorff_search.h"

#include <string>

namespace bot2nurbs {

namespace {

std::optional<Error> check(const SplineSurface& surface, const HausdorffOptions& options)
{
    const auto bad = [](const char* message) {
        return Error{ErrorCode::bad_option, message, invalid_index};
    };
    if (!(options.relative_gap >= 0.0 && options.relative_gap < 1.0))
        return bad("the relative gap of a Hausdorff bound must be at least 0 and below 1");
    if (!(options.absolute_gap >= 0.0) ||
        !(options.relative_gap > 0.0 || options.absolute_gap > 0.0))
        return bad("the absolute gap of a Hausdorff bound must not be negative, and one of the two "
                   "gaps must be above zero");
    if (options.decide && !(*options.decide >= 0.0))
        return bad("a distance to decide about must not be negative");
    const auto& points = surface.bezier();
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!is_finite(points[i]))
            return Error{ErrorCode::bad_geometry,
                         "patch " + std::to_string(i / 169) +
                             " has a coefficient that is not finite",
                         static_cast<Index>(i / 169)};
    return std::nullopt;
}

} // namespace

Result<HausdorffBound> bound_hausdorff(const ManifoldMesh& source, const QuadComplex& complex,
                                       const SplineSurface& surface,
                                       const HausdorffOptions& options, Context& context)
{
    if (source.face_count() == 0 || surface.patch_count() == 0)
        return Error{ErrorCode::empty_input, "nothing to bound the distance of", invalid_index};
    if (auto error = check(surface, options))
        return *error;
    HausdorffSearch search(source, complex, surface, options, context);
    if (!search.run())
        return Context::cancelled_error("bound");
    return search.result();
}

} // namespace bot2nurbs
