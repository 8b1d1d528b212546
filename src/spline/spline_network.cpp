// SPDX-License-Identifier: MIT
#include "bot2nurbs/spline_network.h"

#include "spline/fans.h"
#include "spline/schemes.h"

namespace bot2nurbs {

Result<SplineNetwork> build_spline_network(const QuadComplex& complex, SplineScheme scheme)
{
    auto fans = find_fans(complex);
    if (!fans)
        return fans.error();
    SplineNetwork network;
    network.scheme = scheme;
    network.complex = complex;
    switch (scheme) {
    case SplineScheme::peters: build_peters(complex, *fans, network); break;
    case SplineScheme::eck_hoppe:
        network.c1_inside = false;
        if (Status refused = build_eck_hoppe(complex, *fans, network))
            return *refused;
        break;
    }
    return network;
}

} // namespace bot2nurbs
