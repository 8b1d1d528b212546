// SPDX-License-Identifier: MIT
#include "domain/validate_domain_rules.h"

#include "core/predicates.h"

#include <cmath>
#include <optional>

namespace bot2nurbs {

namespace {

//! Barycentric weights are rounded once each; their sum may be off by a few roundings.
constexpr double weight_sum_slack = 1e-12;
//! How far the areas of a face's parts may be from its own, as a share of it. Parts are compared as
//! a count of layers (0, 1, 2), so anything well below one layer would do.
constexpr double area_slack = 1e-6;

std::string number(std::size_t i)
{
    return std::to_string(i);
}

//! The weights of a point in another face that it lies on as well, or nothing.
std::optional<std::array<double, 3>> weights_in(const ManifoldMesh& source, const SourcePoint& p,
                                                Index face)
{
    if (p.face == face)
        return p.bary;
    std::array<double, 3> weights{};
    for (int k = 0; k < 3; ++k) {
        if (p.bary[k] == 0.0)
            continue;
        const Index v = source.triangle(p.face)[k];
        int corner = 0;
        while (corner < 3 && source.triangle(face)[corner] != v)
            ++corner;
        if (corner == 3)
            return {};
        weights[corner] = p.bary[k];
    }
    return weights;
}

void check_vertices(const ManifoldMesh& source, const CarrierMesh& carrier, DefectList& defects)
{
    const auto add = [&](Index v, const char* what) {
        defects.add("carrier_vertex", "carrier vertex " + number(v) + ' ' + what, v);
    };
    for (Index v = 0; v < carrier.mesh.vertex_count(); ++v) {
        const SourcePoint& p = carrier.vertex_source[v];
        const double sum = p.bary[0] + p.bary[1] + p.bary[2];
        if (!(p.bary[0] >= 0.0 && p.bary[1] >= 0.0 && p.bary[2] >= 0.0 &&
              std::fabs(sum - 1.0) <= weight_sum_slack)) {
            add(v, "has barycentric weights that are negative or not of sum 1");
            continue;
        }
        if (v < source.vertex_count()) {
            bool own = false;
            for (int k = 0; k < 3; ++k)
                own |= p.bary[k] == 1.0 && source.triangle(p.face)[k] == v;
            if (!own) {
                add(v, "is not the source vertex of its number");
                continue;
            }
        }
        if (source.at(p) != carrier.mesh.position(v))
            add(v, "does not lie where its place on the source is");
    }
}

//! The corner of `face` opposite to the source edge on which both points lie, or 3.
int common_edge(const std::array<double, 3>& p, const std::array<double, 3>& q)
{
    int corner = 0;
    while (corner < 3 && (p[corner] != 0.0 || q[corner] != 0.0))
        ++corner;
    return corner;
}

using FaceWeights = std::array<std::array<double, 3>, 3>;

//! Whether side k of a carrier face fits what is across it: another part of the same source face,
//! or a part of the source face across the source edge that the side lies on.
bool side_fits(const ManifoldMesh& source, const CarrierMesh& carrier, Index f, int k,
               const FaceWeights& weights)
{
    const Index twin = carrier.mesh.twin(3 * f + k), face = carrier.face_source[f];
    const Index across =
        twin == invalid_index ? invalid_index : carrier.face_source[ManifoldMesh::face(twin)];
    if (across == face)
        return true;
    const int corner = common_edge(weights[k], weights[(k + 1) % 3]);
    if (corner == 3)
        return false;
    const Index source_twin = source.twin(3 * face + (corner + 1) % 3);
    return source_twin == invalid_index ? across == invalid_index
                                        : across == ManifoldMesh::face(source_twin);
}

void check_faces(const ManifoldMesh& source, const CarrierMesh& carrier, DefectList& defects)
{
    std::vector<double> covered(source.face_count(), 0.0);
    std::vector<Index> misfits;
    for (Index f = 0; f < carrier.mesh.face_count(); ++f) {
        const auto& t = carrier.mesh.triangle(f);
        const Index face = carrier.face_source[f];
        FaceWeights weights{};
        bool inside = true;
        for (int k = 0; k < 3 && inside; ++k) {
            const auto w = weights_in(source, carrier.vertex_source[t[k]], face);
            inside = w.has_value();
            if (inside)
                weights[k] = *w;
        }
        if (!inside) {
            defects.add(
                "carrier_face",
                "carrier face " + number(f) + " is not inside its source face " + number(face), f);
            continue;
        }
        const auto plane = [&](int k) { return Vec2{weights[k][1], weights[k][2]}; };
        // Weights that are rounded to sum 1 leave the edge opposite to corner 0 by a hair, so three
        // points on one edge are found by their zeros, not by orientation.
        bool flat = false;
        for (int c = 0; c < 3; ++c)
            flat |= weights[0][c] == 0.0 && weights[1][c] == 0.0 && weights[2][c] == 0.0;
        if (flat || orient2d(plane(0), plane(1), plane(2)) <= 0) {
            defects.add("carrier_face",
                        "carrier face " + number(f) +
                            " has no area in its source face or is turned over",
                        f);
            continue;
        }
        covered[face] += cross(plane(1) - plane(0), plane(2) - plane(0));
        for (int k = 0; k < 3; ++k)
            if (!side_fits(source, carrier, f, k, weights)) {
                misfits.push_back(f);
                break;
            }
    }
    if (defects.has("carrier_face"))
        return; // Its neighbours need not fit it.
    for (const Index f : misfits)
        defects.add("carrier_tiling", "carrier face " + number(f) + " does not fit its neighbours",
                    f);
    if (!misfits.empty())
        return;
    for (Index face = 0; face < source.face_count(); ++face)
        if (!(std::fabs(covered[face] - 1.0) <= area_slack))
            defects.add("carrier_tiling",
                        "source face " + number(face) + " is covered " +
                            std::to_string(covered[face]) + " times",
                        face);
}

} // namespace

void check_carrier(const ManifoldMesh& source, const CarrierMesh& carrier, DefectList& defects)
{
    if (carrier.mesh.vertex_count() < source.vertex_count()) {
        defects.add("carrier_vertex", "the carrier lacks vertices of the source",
                    carrier.mesh.vertex_count());
        return;
    }
    if (!carrier.refined && (carrier.mesh.positions() != source.positions() ||
                             carrier.mesh.triangles() != source.triangles())) {
        defects.add("carrier_tiling",
                    "the carrier differs from the source but is not marked as refined",
                    invalid_index);
        return;
    }
    check_vertices(source, carrier, defects);
    if (!defects.has("carrier_vertex"))
        check_faces(source, carrier, defects);
}

} // namespace bot2nurbs
