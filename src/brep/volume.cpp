// SPDX-License-Identifier: MIT
#include "brep/volume.h"

#include "brep/bspline.h"

#include <numeric>

namespace bot2nurbs {

namespace {

// The integrand S . (Su x Sv) of a bicubic piece has degree 3 + 2 + 3 = 8 in each parameter, and
// five Gauss nodes integrate degree 9.
constexpr std::array<double, 5> gauss_node{-0.9061798459386640, -0.5384693101056831, 0.0,
                                           0.5384693101056831, 0.9061798459386640};
constexpr std::array<double, 5> gauss_weight{0.2369268850561891, 0.4786286704993665,
                                             0.5688888888888889, 0.4786286704993665,
                                             0.2369268850561891};

//! Basis values at the Gauss nodes of all knot spans of one direction, and the nodes' weights.
struct SpanNodes {
    std::vector<BasisValues> basis;
    std::vector<double> weight;

    explicit SpanNodes(const BsplinePatch& patch)
    {
        for (Index k = patch_order - 2; k + 1 < patch.size; ++k) {
            const double half = 0.5 * (patch.knots[k + 1] - patch.knots[k]);
            if (!(half > 0.0))
                continue;
            for (std::size_t g = 0; g < gauss_node.size(); ++g) {
                const double t = patch.knots[k] + half * (1.0 + gauss_node[g]);
                basis.push_back(bspline_basis(patch.knots, patch_order, patch.size, t));
                weight.push_back(half * gauss_weight[g]);
            }
        }
    }
};

//! Calls visit(weight, position, Su, Sv) at every node of a patch.
template <class Visit> void for_each_node(const BsplinePatch& patch, Visit visit)
{
    const SpanNodes nodes(patch);
    const std::size_t count = nodes.basis.size();
    std::vector<Vec3> value(patch.size), slope(patch.size);
    for (std::size_t m = 0; m < count; ++m) {
        const BasisValues& a = nodes.basis[m];
        for (Index j = 0; j < patch.size; ++j) {
            value[j] = slope[j] = {};
            for (int i = 0; i < patch_order; ++i) {
                const Vec3& c = patch.control[(a.first + i) * patch.size + j];
                value[j] += a.value[i] * c;
                slope[j] += a.derivative[i] * c;
            }
        }
        for (std::size_t n = 0; n < count; ++n) {
            const BasisValues& b = nodes.basis[n];
            PatchPoint p;
            for (int j = 0; j < patch_order; ++j) {
                p.position += b.value[j] * value[b.first + j];
                p.du += b.value[j] * slope[b.first + j];
                p.dv += b.derivative[j] * value[b.first + j];
            }
            visit(nodes.weight[m] * nodes.weight[n], p);
        }
    }
}

} // namespace

double signed_volume(const Brep& brep, const std::vector<Index>& faces, const Vec3& origin)
{
    double volume = 0.0;
    for (Index f : faces) {
        double part = 0.0;
        for_each_node(brep.surfaces[brep.faces[f].surface], [&](double w, const PatchPoint& p) {
            part += w * dot(p.position - origin, cross(p.du, p.dv));
        });
        volume += (brep.faces[f].reversed ? -part : part) / 3.0;
    }
    return volume;
}

double signed_volume(const Brep& brep)
{
    // About the middle of the box, so that a model far from the origin loses no digits.
    Box3 box;
    for (const BsplinePatch& s : brep.surfaces) {
        for (const Vec3& c : s.control)
            box.add(c);
    }
    if (box.empty())
        return 0.0;
    std::vector<Index> faces(brep.faces.size());
    std::iota(faces.begin(), faces.end(), Index{0});
    return signed_volume(brep, faces, box.center());
}

double patch_area(const BsplinePatch& patch)
{
    double area = 0.0;
    for_each_node(patch,
                  [&](double w, const PatchPoint& p) { area += w * norm(cross(p.du, p.dv)); });
    return area;
}

} // namespace bot2nurbs
