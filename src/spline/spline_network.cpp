// SPDX-License-Identifier: MIT
#include "bot2nurbs/spline_network.h"

#include "spline/fans.h"
#include "spline/schemes.h"

#include <string>

namespace bot2nurbs {

Result<SplineNetwork> build_spline_network(const QuadComplex& complex, SplineScheme scheme,
                                           const std::vector<double>& corner_angles)
{
    if (!corner_angles.empty() && corner_angles.size() != complex.halfedge_count())
        return Error{ErrorCode::bad_option,
                     std::to_string(corner_angles.size()) + " angles are not one for each of " +
                         std::to_string(complex.halfedge_count()) + " quad corners",
                     invalid_index};
    auto fans = find_fans(complex, corner_angles);
    if (!fans)
        return fans.error();
    SplineNetwork network;
    network.scheme = scheme;
    network.complex = complex;
    switch (scheme) {
    case SplineScheme::peters: build_peters(complex, *fans, network); break;
    case SplineScheme::full: build_full(complex, *fans, network); break;
    case SplineScheme::eck_hoppe:
        network.c1_inside = false;
        if (Status refused = build_eck_hoppe(complex, *fans, network))
            return *refused;
        break;
    }
    return network;
}

Result<std::vector<Vec3>> recover_unknowns(const SplineNetwork& network,
                                           const SplineSurface& surface)
{
    if (surface.patch_count() != network.complex.quad_count())
        return Error{ErrorCode::invalid_domain,
                     "a surface of " + std::to_string(surface.patch_count()) +
                         " patches is not over a domain of " +
                         std::to_string(network.complex.quad_count()) + " quads",
                     invalid_index};
    const SparseRows& rows = network.recovery;
    if (rows.row_count() != network.unknown_count)
        return Error{ErrorCode::bad_option,
                     "unknowns can be read back from surfaces with the spline scheme full only",
                     invalid_index};
    std::vector<Vec3> unknowns(network.unknown_count);
    for (Index u = 0; u < network.unknown_count; ++u)
        for (std::size_t i = rows.offset[u]; i < rows.offset[u + 1]; ++i)
            unknowns[u] += rows.weight[i] * surface.bezier()[rows.column[i]];
    return unknowns;
}

} // namespace bot2nurbs
