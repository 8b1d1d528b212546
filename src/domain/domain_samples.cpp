// SPDX-License-Identifier: MIT
#include "bot2nurbs/domain_samples.h"

#include "core/parallel.h"
#include "domain/chart_locator.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bot2nurbs {

namespace {

//! Quads of one chunk: a chart takes about a millisecond, far under the cancellation limit.
constexpr std::size_t quads_per_chunk = 4;
constexpr std::size_t vertices_per_chunk = 4096;
//! Fewest samples per direction: one in each of the 4 Bezier pieces.
constexpr Index least_per_side = 4;
//! Share of a quad's mean weight below which no weight falls: a sample of a cell without area (a
//! sliver) must not vanish from the system, nor may a weight be zero.
constexpr double least_weight = 1e-9;

//! A cheap fixed mixing of bits (splitmix64), to pick vertices without regard to their numbering.
std::uint64_t mixed(std::uint64_t x)
{
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

double triangle_area(const QuadChart& chart, Index t)
{
    const auto& v = chart.triangles[t];
    const Vec3& a = chart.vertices[v[0]].position;
    return 0.5 * norm(cross(chart.vertices[v[1]].position - a, chart.vertices[v[2]].position - a));
}

//! A convex polygon in the parameter plane: a triangle clipped by four lines has at most 7 corners.
struct Polygon {
    std::array<Vec2, 8> p;
    int size = 0;

    void add(const Vec2& q) { p[size++] = q; }
    double area() const
    {
        double twice = 0.0;
        for (int k = 2; k < size; ++k)
            twice += cross(p[k - 1] - p[0], p[k] - p[0]);
        return 0.5 * twice;
    }
};

//! The part of a polygon where sign * (coordinate - at) >= 0.
Polygon clipped(const Polygon& polygon, bool along_u, double at, double sign)
{
    Polygon result;
    const auto side = [&](const Vec2& q) { return sign * ((along_u ? q.x : q.y) - at); };
    for (int k = 0; k < polygon.size; ++k) {
        const Vec2 &a = polygon.p[k], &b = polygon.p[(k + 1) % polygon.size];
        const double da = side(a), db = side(b);
        if (da >= 0.0)
            result.add(a);
        if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0))
            result.add(a + (da / (da - db)) * (b - a));
    }
    return result;
}

//! Area on the source of each cell of an n x n grid over the chart, row by row.
std::vector<double> cell_areas(const QuadChart& chart, Index n)
{
    std::vector<double> areas(std::size_t{n} * n, 0.0);
    const auto cell = [n](double x) { return static_cast<Index>(std::clamp(x * n, 0.0, n - 1.0)); };
    for (Index t = 0; t < chart.triangles.size(); ++t) {
        Polygon whole;
        for (const Index v : chart.triangles[t])
            whole.add(chart.vertices[v].uv);
        const auto [u0, u1] = std::minmax({whole.p[0].x, whole.p[1].x, whole.p[2].x});
        const auto [v0, v1] = std::minmax({whole.p[0].y, whole.p[1].y, whole.p[2].y});
        const double area = triangle_area(chart, t), parameter_area = whole.area();
        if ((cell(u0) == cell(u1) && cell(v0) == cell(v1)) || !(parameter_area > 0.0)) {
            areas[std::size_t{cell(v0)} * n + cell(u0)] += area;
            continue;
        }
        for (Index row = cell(v0); row <= cell(v1); ++row) {
            const Polygon strip = clipped(clipped(whole, false, double(row) / n, 1.0), false,
                                          double(row + 1) / n, -1.0);
            for (Index column = cell(u0); column <= cell(u1); ++column) {
                const Polygon piece = clipped(clipped(strip, true, double(column) / n, 1.0), true,
                                              double(column + 1) / n, -1.0);
                areas[std::size_t{row} * n + column] += area * (piece.area() / parameter_area);
            }
        }
    }
    return areas;
}

//! A corner of a chart triangle that is a source vertex.
struct VertexPlace {
    Index vertex = invalid_index; //!< Of the source.
    Index triangle = invalid_index;
    int corner = 0;
    double area = 0.0; //!< A third of the chart's triangles around it.
};

//! The source vertex at a chart triangle's corner, or invalid_index.
Index source_vertex(const ManifoldMesh& source, const QuadChart& chart, Index t, int k)
{
    const auto& bary = chart.bary[t][k];
    for (int i = 0; i < 3; ++i)
        if (bary[i] == 1.0)
            return source.triangle(chart.source_face[t])[i];
    return invalid_index;
}

//! The source vertices of a chart in the order of chart vertices.
std::vector<VertexPlace> vertex_places(const ManifoldMesh& source, const QuadChart& chart)
{
    std::vector<VertexPlace> of_vertex(chart.vertices.size());
    for (Index t = 0; t < chart.triangles.size(); ++t) {
        const double share = triangle_area(chart, t) / 3.0;
        for (int k = 0; k < 3; ++k) {
            VertexPlace& place = of_vertex[chart.triangles[t][k]];
            place.area += share;
            if (place.vertex == invalid_index) {
                place.vertex = source_vertex(source, chart, t, k);
                place.triangle = t;
                place.corner = k;
            }
        }
    }
    std::vector<VertexPlace> places;
    for (const VertexPlace& place : of_vertex)
        if (place.vertex != invalid_index)
            places.push_back(place);
    return places;
}

//! Keeps `count` places spread evenly over the chart: of every cell of a grid one, then of every
//! cell a second one, and so on, in an order within the cell that follows no numbering.
void thin(std::vector<VertexPlace>& places, const QuadChart& chart, Index count, Index grid)
{
    if (places.size() <= count)
        return;
    struct Ranked {
        std::uint64_t order;
        Index cell, rank, place;
    };
    std::vector<Ranked> ranked(places.size());
    for (Index i = 0; i < places.size(); ++i) {
        const Vec2& uv = chart.vertices[chart.triangles[places[i].triangle][places[i].corner]].uv;
        const auto cell = [grid](double x) {
            return static_cast<Index>(std::clamp(x * grid, 0.0, grid - 1.0));
        };
        ranked[i] = {mixed(places[i].vertex), cell(uv.y) * grid + cell(uv.x), 0, i};
    }
    std::sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
        return a.cell != b.cell ? a.cell < b.cell : a.order < b.order;
    });
    for (std::size_t i = 1; i < ranked.size(); ++i)
        ranked[i].rank = ranked[i].cell == ranked[i - 1].cell ? ranked[i - 1].rank + 1 : 0;
    std::sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
        return a.rank != b.rank ? a.rank < b.rank : a.order < b.order;
    });
    std::vector<Index> kept;
    for (Index i = 0; i < count; ++i)
        kept.push_back(ranked[i].place);
    std::sort(kept.begin(), kept.end());
    std::vector<VertexPlace> result;
    for (const Index i : kept)
        result.push_back(places[i]);
    places = std::move(result);
}

//! What all quads share.
struct Sampling {
    const ManifoldMesh& source;
    const SampleOptions& options;
    const std::vector<Vec3>& normals; //!< Of face corners.
    const std::vector<Index>& owner;  //!< Per source vertex: the quad that samples it.
};

Vec3 normal_at(const Sampling& sampling, const SourcePoint& point)
{
    const Vec3 face = sampling.source.area_vector(point.face);
    Vec3 normal;
    for (int k = 0; k < 3; ++k)
        normal += point.bary[k] * sampling.normals[3 * point.face + k];
    // A face without area has no normal to compare with; then the corners' average is all there is.
    if (norm_squared(face) > 0.0 && !(dot(normal, face) > 0.0))
        return normalized(face);
    return normalized(normal);
}

SurfaceSampleSet sample_quad(const Sampling& sampling, const QuadChart& chart, Index quad)
{
    const SampleOptions& options = sampling.options;
    const Index n = options.per_side;
    std::vector<VertexPlace> places;
    if (options.max_vertices > 0) {
        places = vertex_places(sampling.source, chart);
        places.erase(
            std::remove_if(places.begin(), places.end(),
                           [&](const VertexPlace& p) { return sampling.owner[p.vertex] != quad; }),
            places.end());
        thin(places, chart, options.max_vertices, n);
    }

    SurfaceSampleSet set;
    const auto add = [&](const SourcePoint& point, const Vec2& uv, double weight) {
        set.positions.push_back(sampling.source.at(point));
        set.normals.push_back(normal_at(sampling, point));
        set.weights.push_back(weight);
        set.source.push_back(point);
        set.domain.push_back({quad, uv.x, uv.y});
    };
    const ChartLocator locator(chart);
    const std::vector<double> areas = cell_areas(chart, n);
    const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
    const double count = double(n) * n + double(places.size());
    const double grid_share = double(n) * n / count;
    const double least = least_weight * total / count;
    for (Index j = 0; j < n; ++j)
        for (Index i = 0; i < n; ++i) {
            const Vec2 uv{(i + 0.5) / n, (j + 0.5) / n};
            add(source_point(chart, locator.locate(uv)), uv,
                std::max(least, grid_share * areas[std::size_t{j} * n + i]));
        }
    double around = 0.0;
    for (const VertexPlace& place : places)
        around += place.area;
    for (const VertexPlace& place : places) {
        SourcePoint point{chart.source_face[place.triangle],
                          chart.bary[place.triangle][place.corner]};
        const double part = around > 0.0 ? place.area / around : 1.0 / double(places.size());
        add(point, chart.vertices[chart.triangles[place.triangle][place.corner]].uv,
            std::max(least, (1.0 - grid_share) * total * part));
    }
    return set;
}

template <class T> void append(std::vector<T>& to, const std::vector<T>& from)
{
    to.insert(to.end(), from.begin(), from.end());
}

//! Averages over the runs of faces at v that no sharp edge separates.
void vertex_corner_normals(const ManifoldMesh& source, const std::vector<Vec3>& face_normal,
                           double cos_smooth, Index v, std::vector<Index>& fan,
                           std::vector<Vec3>& normals)
{
    fan.clear();
    const Index start = source.halfedge_at(v);
    Index h = start;
    do {
        fan.push_back(h);
        h = source.twin(ManifoldMesh::prev(h));
    } while (h != invalid_index && h != start);
    const bool round = h == start;
    const std::size_t count = fan.size();
    // Whether the edge between fan member i and the next one is sharp; a face without area does
    // not separate.
    const auto sharp_after = [&](std::size_t i) {
        const Vec3& a = face_normal[ManifoldMesh::face(fan[i])];
        const Vec3& b = face_normal[ManifoldMesh::face(fan[(i + 1) % count])];
        return norm_squared(a) > 0.0 && norm_squared(b) > 0.0 && dot(a, b) < cos_smooth;
    };
    std::size_t first = 0; // A run starts here.
    if (round)
        for (std::size_t i = 0; i < count; ++i)
            if (sharp_after(i)) {
                first = (i + 1) % count;
                break;
            }
    for (std::size_t done = 0; done < count;) {
        Vec3 sum;
        std::size_t length = 0;
        for (;;) {
            const Index g = fan[(first + done + length) % count];
            const Vec3 a = normalized(source.position(source.to(g)) - source.position(v));
            const Vec3 b = normalized(source.position(source.from(ManifoldMesh::prev(g))) -
                                      source.position(v));
            sum += std::atan2(norm(cross(a, b)), dot(a, b)) * face_normal[ManifoldMesh::face(g)];
            ++length;
            if (done + length == count || sharp_after((first + done + length - 1) % count))
                break;
        }
        const Vec3 normal = normalized(sum);
        for (std::size_t i = 0; i < length; ++i) {
            const Index g = fan[(first + done + i) % count];
            // Where the average cancels out, a face's own normal is the better answer.
            normals[g] = norm_squared(normal) > 0.0 ? normal : face_normal[ManifoldMesh::face(g)];
        }
        done += length;
    }
}

} // namespace

std::optional<Error> SampleOptions::check() const
{
    if (per_side < least_per_side || per_side > 4096)
        return Error{ErrorCode::bad_option, "per_side must be in 4 .. 4096", invalid_index};
    if (!(smooth_angle >= 0.0 && smooth_angle <= 180.0))
        return Error{ErrorCode::bad_option, "smooth_angle must be in 0 .. 180 degrees",
                     invalid_index};
    return {};
}

std::vector<Vec3> corner_normals(const ManifoldMesh& source, double smooth_angle, Context& context)
{
    std::vector<Vec3> face_normal(source.face_count());
    std::vector<Vec3> normals(source.halfedge_count());
    for (Index f = 0; f < source.face_count(); ++f)
        face_normal[f] = normalized(source.area_vector(f));
    const double cos_smooth = std::cos(smooth_angle * M_PI / 180.0);
    for_each_chunk(context, source.vertex_count(), vertices_per_chunk,
                   [&](std::size_t begin, std::size_t end) {
                       std::vector<Index> fan;
                       for (std::size_t v = begin; v < end; ++v)
                           vertex_corner_normals(source, face_normal, cos_smooth,
                                                 static_cast<Index>(v), fan, normals);
                   });
    return normals;
}

Result<SurfaceSampleSet> make_samples(const ManifoldMesh& source,
                                      const std::vector<QuadChart>& charts,
                                      const SampleOptions& options, Context& context)
{
    if (const auto error = options.check())
        return *error;
    for (Index q = 0; q < charts.size(); ++q)
        if (charts[q].triangles.empty())
            return Error{ErrorCode::invalid_domain,
                         "the chart of quad " + std::to_string(q) + " is empty", q};
    const std::vector<Vec3> normals = corner_normals(source, options.smooth_angle, context);
    std::vector<Index> owner(source.vertex_count(), invalid_index);
    for (Index q = 0; q < charts.size(); ++q)
        for (Index t = 0; t < charts[q].triangles.size(); ++t)
            for (int k = 0; k < 3; ++k) {
                const Index v = source_vertex(source, charts[q], t, k);
                if (v != invalid_index && owner[v] == invalid_index)
                    owner[v] = q;
            }
    std::vector<SurfaceSampleSet> parts(charts.size());
    const Sampling sampling{source, options, normals, owner};
    if (!for_each_chunk(context, charts.size(), quads_per_chunk,
                        [&](std::size_t begin, std::size_t end) {
                            for (std::size_t q = begin; q < end; ++q)
                                parts[q] = sample_quad(sampling, charts[q], static_cast<Index>(q));
                        }))
        return Context::cancelled_error("sampling");
    SurfaceSampleSet set;
    for (const SurfaceSampleSet& part : parts) {
        append(set.positions, part.positions);
        append(set.normals, part.normals);
        append(set.weights, part.weights);
        append(set.source, part.source);
        append(set.domain, part.domain);
    }
    return set;
}

} // namespace bot2nurbs
