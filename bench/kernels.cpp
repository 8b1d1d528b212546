// SPDX-License-Identifier: MIT
//! Micro benchmarks of the kernels that a conversion spends its time in, on a bumpy sphere of the
//! given number of triangles (argument of each benchmark). All run on one thread.

#include "bot2nurbs/closest_point.h"
#include "bot2nurbs/deviation.h"
#include "bot2nurbs/domain_samples.h"
#include "bot2nurbs/fit_network.h"
#include "bot2nurbs/layout.h"
#include "bot2nurbs/quad_domain.h"
#include "bot2nurbs/spline_network.h"
#include "mesh/box_tree.h"
#include "mesh/self_intersection.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

namespace bot2nurbs {

namespace {

constexpr std::int64_t small_mesh = 5000, large_mesh = 80000;

//! A sphere with bumps, cut along meridians and parallels, of about `triangles` triangles.
ManifoldMesh bumpy_sphere(std::int64_t triangles)
{
    const auto rings = static_cast<Index>(std::sqrt(static_cast<double>(triangles) / 4.0));
    const Index around = 2 * rings;
    std::vector<Vec3> positions{{0.0, 0.0, 1.0}};
    for (Index i = 1; i < rings; ++i)
        for (Index j = 0; j < around; ++j) {
            const double a = M_PI * i / rings, b = 2.0 * M_PI * j / around;
            const Vec3 p{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)};
            const double radius =
                1.0 + 0.15 * std::sin(4.0 * p.x) * std::sin(5.0 * p.y + 1.0) * std::cos(3.0 * p.z);
            positions.push_back(radius * p);
        }
    positions.push_back({0.0, 0.0, -1.0});
    const Index south = static_cast<Index>(positions.size()) - 1;
    const auto at = [&](Index i, Index j) { return 1 + (i - 1) * around + j % around; };
    std::vector<std::array<Index, 3>> faces;
    for (Index j = 0; j < around; ++j) {
        faces.push_back({0, at(1, j), at(1, j + 1)});
        faces.push_back({south, at(rings - 1, j + 1), at(rings - 1, j)});
        for (Index i = 1; i + 1 < rings; ++i) {
            faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    auto mesh = ManifoldMesh::build(std::move(positions), std::move(faces));
    if (!mesh)
        std::abort();
    return std::move(*mesh);
}

//! A mesh with everything that is made of it on the way to a surface, made once.
struct Subject {
    explicit Subject(std::int64_t triangles) : mesh(bumpy_sphere(triangles))
    {
        context.threads = 1;
        auto layout = build_layout(mesh, {}, context);
        if (!layout)
            std::abort();
        domain = std::move(layout->domain);
        if (!domain.carrier.refined)
            domain.carrier = CarrierMesh::from_source(mesh);
        auto made_charts = compute_charts(mesh, domain, context);
        auto made_network = build_spline_network(domain.complex, SplineScheme::peters);
        if (!made_charts || !made_network)
            std::abort();
        network = std::move(*made_network);
        auto made_samples = make_samples(mesh, *made_charts, {}, context);
        if (!made_samples)
            std::abort();
        samples = std::move(*made_samples);
        charts = std::move(*made_charts);
    }

    Context context;
    ManifoldMesh mesh;
    QuadDomain domain;
    std::vector<QuadChart> charts;
    SplineNetwork network;
    SurfaceSampleSet samples;
};

Subject& subject(std::int64_t triangles)
{
    static std::map<std::int64_t, Subject> subjects;
    return subjects.try_emplace(triangles, triangles).first->second;
}

FitOptions shortest_fit()
{
    FitOptions options;
    options.max_rounds = 5;
    return options;
}

void box_tree(benchmark::State& state)
{
    const ManifoldMesh mesh = bumpy_sphere(state.range(0));
    std::vector<Box3> boxes(mesh.face_count());
    for (Index f = 0; f < mesh.face_count(); ++f)
        for (const Index v : mesh.triangle(f))
            boxes[f].add(mesh.position(v));
    for (auto _ : state)
        benchmark::DoNotOptimize(BoxTree(boxes).nodes().data());
}

//! Queries half a percent of the radius off the surface, in the order of faces.
void closest_point(benchmark::State& state)
{
    const ManifoldMesh mesh = bumpy_sphere(state.range(0));
    const ClosestPoint tree(mesh);
    Index f = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(tree.query(1.005 * mesh.at({f, {0.2, 0.3, 0.5}})).distance);
        f = f + 1 < mesh.face_count() ? f + 1 : 0;
    }
}

void self_intersections(benchmark::State& state)
{
    const ManifoldMesh mesh = bumpy_sphere(state.range(0));
    Context context;
    context.threads = 1;
    for (auto _ : state)
        benchmark::DoNotOptimize(
            find_self_intersections(mesh.positions(), mesh.triangles(), 10, context).count);
}

//! Overlay and convex map of every quad.
void overlay_and_map(benchmark::State& state)
{
    Subject& s = subject(state.range(0));
    for (auto _ : state)
        benchmark::DoNotOptimize(compute_charts(s.mesh, s.domain, s.context).ok());
    state.counters["patches"] = s.domain.complex.quad_count();
}

void sampling(benchmark::State& state)
{
    Subject& s = subject(state.range(0));
    for (auto _ : state)
        benchmark::DoNotOptimize(make_samples(s.mesh, s.charts, {}, s.context).ok());
}

void network_build(benchmark::State& state)
{
    Subject& s = subject(state.range(0));
    for (auto _ : state)
        benchmark::DoNotOptimize(build_spline_network(s.domain.complex, SplineScheme::peters).ok());
    state.counters["patches"] = s.domain.complex.quad_count();
}

//! Five rounds, the fewest a fit has.
void fit_rounds(benchmark::State& state)
{
    Subject& s = subject(state.range(0));
    for (auto _ : state) {
        SurfaceSampleSet samples = s.samples;
        benchmark::DoNotOptimize(fit_network(s.network, samples, shortest_fit(), s.context).ok());
    }
    state.counters["patches"] = s.domain.complex.quad_count();
}

void deviation(benchmark::State& state)
{
    Subject& s = subject(state.range(0));
    SurfaceSampleSet samples = s.samples;
    const auto fit = fit_network(s.network, samples, shortest_fit(), s.context);
    if (!fit)
        std::abort();
    for (auto _ : state)
        benchmark::DoNotOptimize(
            measure_deviation(s.mesh, s.domain.complex, fit->surface, s.context).ok());
}

BENCHMARK(box_tree)->Arg(small_mesh)->Arg(large_mesh)->Unit(benchmark::kMillisecond);
BENCHMARK(closest_point)->Arg(small_mesh)->Arg(large_mesh);
BENCHMARK(self_intersections)->Arg(small_mesh)->Arg(large_mesh)->Unit(benchmark::kMillisecond);
BENCHMARK(overlay_and_map)->Arg(small_mesh)->Arg(large_mesh)->Unit(benchmark::kMillisecond);
BENCHMARK(sampling)->Arg(small_mesh)->Arg(large_mesh)->Unit(benchmark::kMillisecond);
BENCHMARK(network_build)->Arg(small_mesh)->Unit(benchmark::kMillisecond);
BENCHMARK(fit_rounds)->Arg(small_mesh)->Arg(large_mesh)->Unit(benchmark::kMillisecond);
BENCHMARK(deviation)->Arg(small_mesh)->Arg(large_mesh)->Unit(benchmark::kMillisecond);

} // namespace

} // namespace bot2nurbs

BENCHMARK_MAIN();
