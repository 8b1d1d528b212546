// SPDX-License-Identifier: MIT
#include "fit/fit_loop.h"

#include "core/parallel.h"
#include "fit/bernstein_gram.h"
#include "fit/parameter_correction.h"
#include "fit/plane_quads.h"
#include "fit/stacked_rows.h"
#include "spline/bernstein.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace bot2nurbs {

namespace {

//! Point-distance part of the tangent-distance rows: a tenth in the first tangent round, then a
//! tenth of the last after every accepted round. It is what holds the parametrisation in place;
//! with a floor of 1e-4 many surfaces are still sliding towards their best after nine rounds, below
//! 1e-5 nothing is gained (measured: docs/algorithms/fit.md).
constexpr double first_mu = 0.1;
constexpr double mu_factor = 0.1;
constexpr double mu_floor = 1e-5;
//! The first solve and four corrections, as \cite eck_hoppe_1996 used.
constexpr int least_rounds = 5;
//! Gaps between samples are filled from the third round on: before that they slide far.
constexpr int first_with_gaps = 2;
//! Fairness falls by this a round.
const double fairness_decay = std::sqrt(0.1);
//! Samples of a quad are farther away than noise explains when they are by so many standard
//! deviations: chance would say so of one quad in seven hundred.
constexpr double sure_deviations = 3.0;
//! With more fairness than this a surface is as smooth as it gets.
constexpr double most_fairness = 1e2;
//! In the first round quads that fold get so many times the fairness, up to so many times; those
//! that fold even so have no more than the others.
constexpr double raise_at_fold = 10.0;
constexpr int most_raises = 3;
//! A quad with this many samples, two for each of its unknowns, keeps the fairness at
//! `sparse_fairness`; with four times as many the data alone decide down to 1e-7.
constexpr double sparse_samples = 30.0;
constexpr double sparse_fairness = 1e-4;
constexpr double sparse_power = 5.0;
//! Huber's constant: 95 % efficiency for normal errors.
constexpr double huber = 1.345;
//! Largest addition to the weight of a sample for its distance: beyond, single samples that no
//! surface of the network can reach would take hold of it.
constexpr double most_emphasis = 10.0;
//! Weight of samples in plane quads: a bend in a plane face is seen at once, so such a quad yields
//! less to what pulls at its rim.
constexpr double plane_emphasis = 64.0;
//! Standard deviation of normal errors over their median absolute value.
constexpr double mad_to_deviation = 1.4826;
//! Distances below this share of the box are rounding, not noise, and get full weight.
constexpr double least_deviation = 1e-12;
//! Times a round is solved again because it folds the surface somewhere. Once does for nearly all
//! of it; more cost a solve each and gain nothing that is measurable, as the shortened moves are
//! few.
constexpr int max_answers = 1;
//! Moves that fold are halved three times where they do before they are left out, with more and
//! more neighbours.
constexpr int halvings = 3;
constexpr int max_cuts = 8;
//! Smallest share of a point-distance step that is tried.
constexpr double least_step = 0.125;
//! An accepted round may raise the objective by rounding only.
constexpr double rounding = 1e-12;
//! A place counts with at least this share of the mean area per parameter, so that collapsed places
//! neither outweigh all others nor lose their fairness.
constexpr double least_share = 1e-3;
//! Above this many multiplications (about a minute) a coupled factorisation is not attempted and
//! point-distance rows are used instead.
constexpr double coupled_work_limit = 6e10;
constexpr std::size_t chunk_quads = 16;
constexpr std::size_t chunk_samples = 512;

double now()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

//! Thin-plate energy of every quad over [0, 4]^2.
std::vector<double> quad_energies(const SplineSurface& surface, const Context& context)
{
    const Matrix16& e = thin_plate_matrix();
    std::vector<double> energy(surface.patch_count(), 0.0);
    for_each_chunk(context, energy.size(), chunk_quads, [&](std::size_t begin, std::size_t end) {
        Eigen::Matrix<double, 16, 3> x;
        constexpr Index pieces = ReducedNetwork::pieces_per_quad;
        for (Index p = static_cast<Index>(begin) * pieces; p < end * pieces; ++p) {
            for (Index i = 0; i < 16; ++i) {
                const Vec3& c = surface.bezier()[bezier_index(p, i)];
                x.row(i) << c.x, c.y, c.z;
            }
            energy[p / pieces] += (x.cwiseProduct(e * x)).sum();
        }
    });
    return energy;
}

//! Area per unit of the quad's parameters at a foot, kept away from zero by the mean.
double speed_at(const SurfacePoint& s, double mean)
{
    return std::max(norm(cross(s.du, s.dv)), least_share * mean);
}

} // namespace

FitLoop::FitLoop(const SplineNetwork& network, const ReducedNetwork& reduced,
                 const FitOptions& options, Context& context)
    : network_(network), reduced_(reduced), options_(options), context_(context),
      system_(reduced, context), guard_(network.complex), response_(network.complex, reduced)
{
    // Each of the 27 multiplications of a 3 x 3 block product, half of them by symmetry.
    coupled_affordable_ = 0.5 * 27.0 * system_.factor_work() <= coupled_work_limit;
}

void FitLoop::weigh_by_samples()
{
    const Index quads = network_.complex.quad_count();
    const double mean = 1.0 / quads;
    std::vector<double> share(quads, 0.0);
    for (std::size_t i = 0; i < where.size(); ++i)
        share[where[i].quad] += weights[i];
    for (double& s : share)
        s = std::max(s, least_share * mean);
    row_weights_ = weights;
    for (std::size_t i = 0; i < where.size(); ++i)
        row_weights_[i] *= std::sqrt(mean / share[where[i].quad]);
    quad_share_.resize(quads);
    for (Index q = 0; q < quads; ++q)
        quad_share_[q] = std::sqrt(share[q] * mean) / 16.0;
}

void FitLoop::weigh_by_surface(const State& state)
{
    constexpr int side = 2 * pieces_per_side;
    constexpr double places = side * side;
    const Index quads = network_.complex.quad_count();
    std::vector<double> speed(quads * static_cast<std::size_t>(side * side));
    for_each_chunk(context_, quads, chunk_quads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin * side * side; k < end * side * side; ++k) {
            const auto i = static_cast<int>(k / side % side), j = static_cast<int>(k % side);
            const SurfacePoint s = state.surface.evaluate(
                {static_cast<Index>(k / (side * side)), (i + 0.5) / side, (j + 0.5) / side});
            speed[k] = norm(cross(s.du, s.dv));
        }
    });
    double area = 0.0;
    for (const double s : speed)
        area += s / places;
    const double mean = area / quads;
    for (std::size_t i = 0; i < weights.size(); ++i)
        row_weights_[i] = weights[i] * std::sqrt(mean / speed_at(state.feet[i].surface, mean));
    quad_share_.assign(quads, 0.0);
    for (std::size_t k = 0; k < speed.size(); ++k)
        quad_share_[k / (side * side)] +=
            std::sqrt(std::max(speed[k], least_share * mean) * mean) / (places * 16.0 * area);
}

std::vector<char> FitLoop::within_noise(const State& state) const
{
    if (options_.noise == 0.0)
        return {};
    std::vector<char> within(level_.size(), 0);
    if (rms_distance(state) > options_.noise)
        return within;
    std::vector<double> sum(level_.size(), 0.0), count(level_.size(), 0.0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const FootPoint& foot = state.feet[i];
        sum[foot.where.quad] += foot.distance * foot.distance;
        count[foot.where.quad] += 1.0;
    }
    for (std::size_t q = 0; q < within.size(); ++q)
        if (count[q] == 0.0) {
            within[q] = 1;
        } else {
            // Relative standard deviation of the deviation that so many normal errors show.
            const double chance = 1.0 / std::sqrt(2.0 * count[q]);
            within[q] =
                std::sqrt(sum[q] / count[q]) <= (1.0 + sure_deviations * chance) * options_.noise;
        }
    return within;
}

void FitLoop::scale_fairness(double share, const std::vector<char>& held)
{
    last_level_ = level_;
    if (std::count(held.begin(), held.end(), 1) < static_cast<std::ptrdiff_t>(level_.size()))
        round_fairness_ = std::max(options_.fairness_floor, share * round_fairness_);
    // What was raised at folds comes down to the others by the last round but one.
    const int left = options_.max_rounds - static_cast<int>(summary.rounds.size());
    for (std::size_t q = 0; q < level_.size(); ++q) {
        if (!held.empty() && held[q] != 0)
            continue;
        const double level = share * level_[q];
        const double down = std::pow(round_fairness_ / level, 1.0 / std::max(1, left - 1));
        level_[q] = std::max(floor_[q], std::min(1.0, down) * level);
    }
    apply_fairness();
}

void FitLoop::apply_fairness()
{
    fairness_.resize(level_.size());
    for (std::size_t q = 0; q < fairness_.size(); ++q)
        fairness_[q] = level_[q] * quad_share_[q];
}

std::vector<FitRow> FitLoop::rows_at(const State& state, const std::vector<double>& factors) const
{
    const SurfaceWalk walk(network_.complex, state.surface);
    std::vector<FitRow> rows(points.size());
    const auto row_at = [&](std::size_t i) {
        FitRow row;
        const DomainPoint& d = where[i];
        const PieceParameter u = piece_parameter(d.u), v = piece_parameter(d.v);
        row.piece = 16 * d.quad + 4 * u.piece + v.piece;
        row.s = u.t;
        row.t = v.t;
        row.weight = row_weights_[i] * factors[i];
        if (state.feet.empty()) {
            row.residual = points[i];
            return row;
        }
        const SurfacePoint& s = state.feet[i].surface;
        row.residual = points[i] - s.position;
        row.least_mu = response_.least_mu(d.quad);
        // The distance to a rim grows in every direction across it.
        row.of_curve = !on_curve.empty() && on_curve[i];
        if (row.of_curve)
            row.normal = walk.curve_tangent(state.feet[i]);
        else if (!on_sharp_edge(network_.complex, d))
            row.normal = normalized(cross(s.du, s.dv));
        return row;
    };
    for_each_chunk(context_, points.size(), chunk_samples, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            rows[i] = row_at(i);
    });
    return rows;
}

std::vector<double> FitLoop::distance_factors(const State& state, double mu) const
{
    std::vector<double> factors(points.size(), 1.0);
    if (state.feet.empty())
        return factors;
    // Point-distance rows would hold back what slides in the plane as well.
    if (mu < 1.0)
        for (std::size_t i = 0; i < points.size(); ++i)
            if (in_plane_[i])
                factors[i] = plane_emphasis;
    if (emphasis > 0.0)
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double ratio = state.feet[i].distance / emphasis;
            factors[i] *= 1.0 + std::min(most_emphasis, ratio * ratio);
        }
    if (!options_.robust)
        return factors;
    std::vector<double> distance(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        distance[i] = state.feet[i].distance;
    const double deviation =
        std::max({mad_to_deviation * median(distance), least_deviation, options_.least_deviation});
    for (std::size_t i = 0; i < points.size(); ++i)
        if (distance[i] > huber * deviation)
            factors[i] *= huber * deviation / distance[i];
    return factors;
}

double FitLoop::objective(const State& state, const std::vector<double>& factors) const
{
    double sum = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
        sum += row_weights_[i] * factors[i] * state.feet[i].distance * state.feet[i].distance;
    for (std::size_t q = 0; q < fairness_.size(); ++q)
        sum += fairness_[q] * state.quad_energy[q];
    return sum;
}

FitLoop::State FitLoop::moved(const State& state, const std::vector<Vec3>& move) const
{
    State next;
    next.unknowns = state.unknowns;
    for (std::size_t i = 0; i < move.size(); ++i)
        next.unknowns[i] += move[i];
    next.surface = SplineSurface(network_, reduced_.expand(next.unknowns));
    next.folds = guard_.folds(next.surface, context_);
    return next;
}

FitLoop::State FitLoop::moved_without_folds(const State& state, std::vector<Vec3> move) const
{
    State next = moved(state, move);
    for (int cut = 1; cut <= max_cuts; ++cut) {
        std::vector<Index> folded = more_folded(state.folds, next.folds);
        if (folded.empty())
            return next;
        // Halves first; then nothing moves there, nor, from time to time, around it.
        const int stops = cut - halvings;
        for (int ring = 1; ring < stops; ++ring)
            folded = response_.with_neighbours(folded);
        response_.shorten(folded, stops > 0 ? 0.0 : 0.5, move);
        next = moved(state, move);
    }
    return more_folded(state.folds, next.folds).empty() ? next : moved(state, {});
}

Status FitLoop::find_feet(State& state) const
{
    state.quad_energy = quad_energies(state.surface, context_);
    state.feet =
        correct_parameters(network_.complex, state.surface, points, where, on_curve, context_);
    if (context_.cancelled())
        return Context::cancelled_error("fit");
    return std::nullopt;
}

NormalSystem::Solution FitLoop::solve(const State& state, const std::vector<FitRow>& rows,
                                      double mu, const std::vector<Vec3>* start)
{
    if (context_.cancelled())
        return {}; // some rows may not have been made
    const RowsByPiece groups = group_by_piece(rows, reduced_.piece_count());
    RoundProblem problem;
    problem.rows = &rows;
    problem.groups = &groups;
    problem.bezier = &state.surface.bezier();
    problem.fairness = &fairness_;
    problem.mu = mu;
    problem.start = start;
    NormalSystem::Solution solution = system_.solve(problem, options_.condition_limit, context_);
    if (!solution.ok && mu >= 1.0 && !context_.cancelled()) {
        solution = solve_stacked_rows(reduced_, problem, context_);
        summary.used_fallback = summary.used_fallback || solution.ok;
    }
    if (solution.ok && solution.condition > 0.0)
        summary.condition = solution.condition;
    return solution;
}

Status FitLoop::first_round(State& state)
{
    state.unknowns.assign(reduced_.free_count(), Vec3{});
    const std::vector<FitRow> rows = rows_at(state, std::vector<double>(points.size(), 1.0));
    const NormalSystem::Solution solution = solve(state, rows, 1.0);
    if (context_.cancelled())
        return Context::cancelled_error("fit");
    if (!solution.ok)
        return Error{ErrorCode::fit_failed, "the first least-squares system could not be solved",
                     invalid_index};
    state = moved(state, solution.move);
    return std::nullopt;
}

double FitLoop::rms_distance(const State& state) const
{
    double sum = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
        sum += weights[i] * state.feet[i].distance * state.feet[i].distance;
    return std::sqrt(sum);
}

Status FitLoop::raise_to_noise(State& state)
{
    if (const auto error = find_feet(state))
        return error;
    while (rms_distance(state) < options_.noise && round_fairness_ < most_fairness) {
        scale_fairness(1.0 / fairness_decay, {});
        state = {};
        if (const auto error = first_round(state))
            return error;
        if (const auto error = find_feet(state))
            return error;
    }
    return std::nullopt;
}

Status FitLoop::raise_at_folds(State& state)
{
    guard_.set_source(normals, where);
    state.folds = guard_.folds(state.surface, context_);
    std::vector<int> raises(state.folds.size(), 0);
    for (;;) {
        bool changed = false;
        for (Index q = 0; q < raises.size(); ++q) {
            if (state.folds[q] == 0 || raises[q] > most_raises)
                continue;
            changed = true;
            level_[q] = raises[q]++ < most_raises ? raise_at_fold * level_[q] : round_fairness_;
        }
        if (!changed)
            break;
        apply_fairness();
        state = {};
        if (const auto error = first_round(state))
            return error;
    }
    return state.feet.empty() ? find_feet(state) : std::nullopt;
}

Status FitLoop::next_round(State& state, double& mu, bool& stuck)
{
    scale_fairness(fairness_decay, within_noise(state));
    const std::vector<double> factors = distance_factors(state, mu);
    NormalSystem::Solution solution;
    const std::vector<Vec3>* start = nullptr;
    for (int answers = 0;;) {
        solution = solve(state, rows_at(state, factors), mu, start);
        start = nullptr;
        if (context_.cancelled())
            return Context::cancelled_error("fit");
        if (!solution.ok && mu >= 1.0)
            return Error{ErrorCode::fit_failed,
                         "the least-squares system of round " +
                             std::to_string(summary.rounds.size() + 1) + " could not be solved",
                         invalid_index};
        if (solution.ok) {
            State next = moved(state, solution.move);
            const std::vector<Index> folded = more_folded(state.folds, next.folds);
            // Fairness that falls further is one thing that folds a surface, sliding is the other.
            if (!folded.empty())
                response_.respond(folded, mu);
            if (!folded.empty() && answers++ < max_answers) {
                // Not more than at the beginning, for what was raised at folds must come down.
                for (const Index q : folded)
                    floor_[q] = level_[q] =
                        std::max(floor_[q], std::min(options_.fairness, last_level_[q]));
                apply_fairness();
                start = &solution.move;
                continue;
            }
            for (double share = 1.0; share >= least_step; share *= 0.5) {
                if (!folded.empty() || share < 1.0)
                    next = moved_without_folds(state, solution.move);
                if (const auto error = find_feet(next))
                    return error;
                if (objective(next, factors) <= objective(state, factors) * (1.0 + rounding)) {
                    state = std::move(next);
                    return std::nullopt;
                }
                if (mu < 1.0)
                    break;
                for (Vec3& m : solution.move)
                    m *= 0.5;
            }
        }
        if (mu < 1.0) {
            mu = std::min(1.0, mu / mu_factor);
        } else {
            // Point-distance rows lower the objective whatever the feet do, so only rounding is
            // left.
            stuck = true;
            return std::nullopt;
        }
    }
}

Index FitLoop::take_feet(State& state)
{
    Index crossed = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const FootPoint& foot = state.feet[i];
        if (foot.where.quad != where[i].quad)
            ++crossed;
        where[i] = foot.where;
    }
    guard_.set_source(normals, where);
    state.folds = guard_.folds(state.surface, context_);
    return crossed;
}

void FitLoop::record(State& state, double mu, double start)
{
    FitRound round;
    round.crossed = take_feet(state);
    for (const FootPoint& foot : state.feet)
        round.max = std::max(round.max, foot.distance);
    round.rms = rms_distance(state);
    round.fairness = round_fairness_;
    round.damping = mu;
    round.seconds = now() - start;
    summary.rounds.push_back(round);
    context_.progress(
        std::min(1.0, static_cast<double>(summary.rounds.size()) / options_.max_rounds));
}

Status FitLoop::run()
{
    if (context_.cancelled())
        return Context::cancelled_error("fit");
    summary.unknowns = reduced_.free_count();
    summary.samples = static_cast<Index>(points.size());
    std::vector<double> count(network_.complex.quad_count(), 0.0);
    for (const DomainPoint& d : where)
        count[d.quad] += 1.0;
    floor_.resize(count.size());
    for (std::size_t q = 0; q < count.size(); ++q) {
        const double sparse =
            sparse_fairness *
            std::pow(sparse_samples / std::max(count[q], sparse_samples), sparse_power);
        floor_[q] = std::clamp(sparse, options_.fairness_floor, options_.fairness);
    }

    double start = now();
    State state;
    weigh_by_samples();
    round_fairness_ = options_.fairness;
    level_.assign(floor_.size(), options_.fairness);
    apply_fairness();
    in_plane_ = in_plane_quads(network_.complex.quad_count(), points, normals, where, on_curve);
    if (const auto error = first_round(state))
        return error;
    if (const auto error = raise_to_noise(state))
        return error;
    if (const auto error = raise_at_folds(state))
        return error;
    weigh_by_surface(state);
    record(state, 1.0, start);

    const bool tangent = options_.rows == DistanceRows::tangent && coupled_affordable_;
    double mu = tangent ? first_mu : 1.0;
    summary.termination = "round_limit";
    for (int round = 1; round < options_.max_rounds; ++round) {
        start = now();
        const double before = summary.rounds.back().rms;
        bool stuck = false;
        if (const auto error = next_round(state, mu, stuck))
            return error;
        record(state, mu, start);
        const double after = summary.rounds.back().rms;
        const std::vector<char> held = within_noise(state);
        const bool fairness_done = round_fairness_ <= options_.fairness_floor ||
                                   (!held.empty() && std::count(held.begin(), held.end(), 0) == 0);
        const bool schedule_done = (!tangent || mu <= mu_floor) && fairness_done;
        // A stuck round leaves the surface as it is; with less fairness the next may do more.
        if (round + 1 >= least_rounds &&
            (stuck || (schedule_done && after >= (1.0 - options_.stall) * before))) {
            summary.termination = "stalled";
            break;
        }
        if (tangent)
            mu = std::max(mu_floor, mu_factor * mu);
        if (round >= first_with_gaps)
            if (const auto error = fill_gaps(state))
                return error;
    }
    if (const auto error = unfold(state, now()))
        return error;
    summary.smallest_jacobians = guard_.smallest_jacobians(state.surface, context_);
    summary.folded_patches = static_cast<Index>(std::count_if(
        state.folds.begin(), state.folds.end(), [](Index places) { return places > 0; }));
    unknowns = std::move(state.unknowns);
    return std::nullopt;
}

} // namespace bot2nurbs
