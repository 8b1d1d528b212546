// SPDX-License-Identifier: MIT
//! Prints the tables of docs/algorithms/fit.md: errors and convergence of fits of analytic
//! surfaces, and processor time. Not a test: tests/fit/fit_accuracy_test.cpp holds the bounds.

#include "analytic_targets.h"

#include <cstdio>
#include <cstdlib>
#include <ctime>

using namespace bot2nurbs;
using namespace bot2nurbs::test;

namespace {

struct Run {
    FitResult result;
    TargetError error;
    double seconds = 0.0;
};

Run run(const Target& target, SplineScheme scheme, const FitOptions& options)
{
    const auto network = build_spline_network(target.domain.complex, scheme);
    SurfaceSampleSet samples = sample_target(target);
    Context context;
    context.threads = 1;
    const std::clock_t start = std::clock();
    auto fit = fit_network(*network, samples, options, context);
    Run r;
    r.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    if (!fit) {
        std::fprintf(stderr, "%s\n", fit.error().message.c_str());
        std::exit(1);
    }
    r.result = std::move(*fit);
    r.error = target_error(target, r.result.surface);
    return r;
}

void error_row(const char* name, const Target& target, SplineScheme scheme,
               const FitOptions& options)
{
    const Run r = run(target, scheme, options);
    std::printf("| %s | %s | %u | %u | %.1e | %.1e | %d | %.0e | %.2f |\n", name,
                scheme == SplineScheme::peters ? "peters" : "eck_hoppe",
                target.domain.complex.quad_count(), r.result.summary.unknowns, r.error.max,
                r.error.rms, r.error.folds, r.result.summary.condition, r.seconds);
    std::fflush(stdout);
}

void round_row(const char* name, const Target& target, const FitOptions& options)
{
    const Run r = run(target, SplineScheme::peters, options);
    std::printf("| %s |", name);
    for (const FitRound& round : r.result.summary.rounds)
        std::printf(" %.1e |", 100.0 * round.rms / target.diagonal);
    std::printf("\n");
    std::fflush(stdout);
}

} // namespace

int main()
{
    FitOptions options;
    options.max_rounds = 9;
    options.fairness_floor = 1e-7;
    options.stall = 0.0;
    std::printf("| target | scheme | patches | unknowns | max %% | rms %% | folds | condition | "
                "CPU s |\n|---|---|---|---|---|---|---|---|---|\n");
    for (const SplineScheme scheme : {SplineScheme::peters, SplineScheme::eck_hoppe})
        for (const int level : {0, 1, 2})
            error_row(("sphere " + std::to_string(level)).c_str(), sphere_target(level), scheme,
                      options);
    for (const Index n : {5u, 6u, 7u, 8u})
        error_row(("sphere, valence " + std::to_string(n)).c_str(),
                  sphere_target(fixtures::split_bipyramid(n)), SplineScheme::peters, options);
    for (const Index n : {8u, 16u, 24u})
        error_row(("torus " + std::to_string(n) + " x " + std::to_string(n / 2)).c_str(),
                  torus_target(n, n / 2), SplineScheme::peters, options);
    error_row("voxel ring, floor 1e-7", voxel_ring_target(), SplineScheme::peters, options);
    options.fairness_floor = 1e-6;
    error_row("voxel ring, floor 1e-6", voxel_ring_target(), SplineScheme::peters, options);

    options = {};
    options.max_rounds = 12;
    options.stall = 0.0;
    std::printf("\n| rms %% after round | 1 | 2 | 3 | 4 | 5 | 6 | 7 | 8 | 9 | 10 | 11 | 12 |\n"
                "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const DistanceRows rows : {DistanceRows::tangent, DistanceRows::point}) {
        options.rows = rows;
        const std::string kind = rows == DistanceRows::tangent ? ", tangent" : ", point";
        round_row(("sphere 0" + kind).c_str(), sphere_target(0), options);
        round_row(("sphere 1" + kind).c_str(), sphere_target(1), options);
        round_row(("voxel ring" + kind).c_str(), voxel_ring_target(), options);
        round_row(("torus 8 x 4" + kind).c_str(), torus_target(8, 4), options);
    }
}
