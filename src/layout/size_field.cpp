// SPDX-License-Identifier: MIT
#include "layout/size_field.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

// Density follows the square root of curvature within these bounds: patches of very different size
// beside each other cost more in distortion than they save in error.
constexpr double min_density = 0.7;
constexpr double max_density = 1.8;
// More smoothing rounds than this on very dense meshes would cost more than the layout.
constexpr int max_rounds = 60;
constexpr std::size_t chunk_elements = 16384;

// body(i) for every i below count, side by side.
template <class Body> void for_all(const Context& context, Index count, const Body& body)
{
    for_each_chunk(context, count, chunk_elements, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            body(static_cast<Index>(i));
    });
}

// The neighbours of every vertex, in one array.
class Rings {
public:
    explicit Rings(const ManifoldMesh& mesh) : offset_(mesh.vertex_count() + 1, 0)
    {
        for (Index h = 0; h < mesh.halfedge_count(); ++h)
            ++offset_[mesh.from(h) + 1];
        for (std::size_t v = 1; v < offset_.size(); ++v)
            offset_[v] += offset_[v - 1];
        neighbour_.resize(mesh.halfedge_count());
        std::vector<Index> next(offset_.begin(), offset_.end() - 1);
        for (Index h = 0; h < mesh.halfedge_count(); ++h)
            neighbour_[next[mesh.from(h)]++] = mesh.to(h);
    }

    // So many rounds of averaging over neighbours, weighted by area.
    template <class T> void smooth(const std::vector<double>& area, int rounds,
                                   const Context& context, std::vector<T>& value) const
    {
        std::vector<T> last;
        for (int r = 0; r < rounds; ++r) {
            last = value;
            for_all(context, static_cast<Index>(value.size()),
                    [&](Index v) { value[v] = averaged(v, area, last); });
        }
    }

private:
    template <class T>
    T averaged(Index v, const std::vector<double>& area, const std::vector<T>& value) const
    {
        T sum{};
        double weight = 0.0;
        for (Index i = offset_[v]; i < offset_[v + 1]; ++i) {
            sum = sum + area[neighbour_[i]] * value[neighbour_[i]];
            weight += area[neighbour_[i]];
        }
        return weight > 0.0 ? 0.5 * value[v] + (0.5 / weight) * sum : value[v];
    }

    std::vector<Index> offset_, neighbour_;
};

// |dn|^2 over a triangle, which is k1^2 + k2^2 for the linear interpolant of the normals, times its
// area. `most`: bound of |dn|^2.
double bending_of(const ManifoldMesh& mesh, Index face, const std::vector<Vec3>& normal,
                  double most)
{
    const auto& t = mesh.triangle(face);
    const Vec3 p = mesh.position(t[1]) - mesh.position(t[0]);
    const Vec3 q = mesh.position(t[2]) - mesh.position(t[0]);
    const Vec3 dp = normal[t[1]] - normal[t[0]], dq = normal[t[2]] - normal[t[0]];
    const double det = norm_squared(cross(p, q));
    if (!(det > 0.0))
        return 0.0;
    const double gradient =
        (dot(dp, dp) * dot(q, q) - 2.0 * dot(dp, dq) * dot(p, q) + dot(dq, dq) * dot(p, p)) / det;
    return std::clamp(gradient, 0.0, most) * (0.5 * std::sqrt(det));
}

} // namespace

double scaled_area(const ManifoldMesh& mesh, const std::vector<double>& density)
{
    double area = 0.0;
    for (Index f = 0; f < mesh.face_count(); ++f) {
        const auto& t = mesh.triangle(f);
        const double d = (density[t[0]] + density[t[1]] + density[t[2]]) / 3.0;
        area += 0.5 * norm(mesh.area_vector(f)) * d * d;
    }
    return area;
}

SizeField measure_size_field(const ManifoldMesh& mesh, double smoothing, const Context& context)
{
    const Index n = mesh.vertex_count();
    std::vector<Vec3> normal(n);
    std::vector<double> area(n, 0.0);
    std::vector<double> third(mesh.face_count()), edges_squared(mesh.face_count());
    for_all(context, mesh.face_count(), [&](Index f) {
        const auto& t = mesh.triangle(f);
        third[f] = norm(mesh.area_vector(f)) / 6.0;
        for (int k = 0; k < 3; ++k)
            edges_squared[f] += norm_squared(mesh.position(t[k]) - mesh.position(t[(k + 1) % 3]));
    });
    double edge_sum = 0.0;
    for (Index f = 0; f < mesh.face_count(); ++f) {
        const Vec3 a = mesh.area_vector(f);
        for (const Index v : mesh.triangle(f)) {
            normal[v] += a;
            area[v] += third[f];
        }
        edge_sum += edges_squared[f];
    }
    // Averaging over a ring r times spreads over sqrt(r / 2) edge lengths.
    const double edge = std::sqrt(edge_sum / (3.0 * static_cast<double>(mesh.face_count())));
    const double ratio = edge > 0.0 ? smoothing / edge : 0.0;
    const int rounds =
        static_cast<int>(std::min<double>(max_rounds, std::ceil(2.0 * ratio * ratio)));
    const Rings rings(mesh);
    rings.smooth(area, rounds, context, normal);
    for_all(context, n, [&](Index v) { normal[v] = normalized(normal[v]); });

    // The normals of a needle's corners tell little about curvature across it: a turn of the normal
    // over the smoothing length is all that can be meant.
    const double most = 4.0 / (smoothing * smoothing);
    std::vector<double> bending(mesh.face_count());
    for_all(context, mesh.face_count(),
            [&](Index f) { bending[f] = bending_of(mesh, f, normal, most); });
    std::vector<double> squared(n, 0.0);
    SizeField field;
    for (Index f = 0; f < mesh.face_count(); ++f) {
        field.bending += bending[f];
        for (const Index v : mesh.triangle(f))
            squared[v] += bending[f] / 3.0;
    }
    for (Index v = 0; v < n; ++v)
        squared[v] = area[v] > 0.0 ? squared[v] / area[v] : 0.0;
    rings.smooth(area, rounds, context, squared);

    field.density.assign(n, 1.0);
    for_all(context, n, [&](Index v) { field.density[v] = std::pow(squared[v], 0.25); });
    double total = 0.0, mean = 0.0;
    for (Index v = 0; v < n; ++v) {
        total += area[v];
        mean += area[v] * field.density[v];
    }
    mean = total > 0.0 ? mean / total : 0.0;
    for (double& d : field.density)
        d = mean > 0.0 ? std::clamp(d / mean, min_density, max_density) : 1.0;
    return field;
}

} // namespace bot2nurbs
