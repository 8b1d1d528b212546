// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/fit_network.h"
#include "fit/fold_easing.h"
#include "fit/fold_guard.h"
#include "fit/fold_response.h"
#include "fit/foot_point.h"
#include "fit/local_system.h"
#include "fit/normal_system.h"

#include <vector>

namespace bot2nurbs {

//! The rounds of a fit, in normalised units: points in a unit box, weights that sum to one.
class FitLoop {
public:
    FitLoop(const SplineNetwork& network, const ReducedNetwork& reduced, const FitOptions& options,
            Context& context);

    // In.
    std::vector<Vec3> points;
    std::vector<double> weights;
    std::vector<Vec3> normals;  //!< Unit normals of the source; may be empty.
    std::vector<char> on_curve; //!< As in SurfaceSampleSet.
    double emphasis = 0.0;      //!< As in FitOptions.
    NearestPlace nearest;       //!< May be empty.
    // In and out.
    std::vector<DomainPoint> where;
    // Out.
    std::vector<Vec3> unknowns; //!< The free ones.
    FitSummary summary;

    //! Errors: fit_failed, cancelled.
    Status run();

private:
    //! Surface, feet and energies for one set of unknowns.
    struct State {
        std::vector<Vec3> unknowns;
        SplineSurface surface;
        std::vector<FootPoint> feet;
        std::vector<double> quad_energy; //!< Thin-plate energy, unweighted.
        std::vector<Index> folds;        //!< Per quad.
    };

    //! Without feet.
    Status first_round(State& state);
    //! \return true in `stuck` when no step lowers the objective without new folds.
    Status next_round(State& state, double& mu, bool& stuck);
    //! Solves from `state` with the given rows. Falls back to QR where that is the answer.
    //! `start`: see RoundProblem.
    NormalSystem::Solution solve(const State& state, const std::vector<FitRow>& rows, double mu,
                                 const std::vector<Vec3>* start = nullptr);
    //! The state after moving the unknowns, without feet.
    State moved(const State& state, const std::vector<Vec3>& move) const;
    //! Like `moved`, after shortening the move where it folds, as little as it takes.
    State moved_without_folds(const State& state, std::vector<Vec3> move) const;
    //! Adds the feet. Errors: cancelled.
    Status find_feet(State& state) const;
    //! Rows of all samples, as the fold response wants them.
    std::vector<FitRow> rows_at(const State& state, const std::vector<double>& factors) const;
    //! What the distances make of the weights: more with emphasis, less where robust; and more in
    //! plane quads while rows are not those of point distances.
    std::vector<double> distance_factors(const State& state, double mu) const;
    double objective(const State& state, const std::vector<double>& factors) const;
    //! First round: halfway (geometrically) between weighing quads by area and alike. Weights by
    //! area alone let a large quad follow its samples at the cost of a small one beside it, whose
    //! part of their common parametrization it stretches until the small one folds.
    void weigh_by_samples();
    //! Later rounds: the same, place by place: between weighing by area and by parameters, in which
    //! the energy is measured. Weights by area alone leave the largest errors at extraordinary
    //! vertices, where parameters crowd.
    void weigh_by_surface(const State& state);
    //! Fairness of the quads `share` times the last round's, but not below their floors; that of
    //! those that are `held` stays. Empty: none is.
    void scale_fairness(double share, const std::vector<char>& held);
    //! Per quad: whether all samples together are no farther away than their noise, and those of
    //! the quad not surely. Empty without noise.
    std::vector<char> within_noise(const State& state) const;
    //! Repeats the first round with more fairness while the surface follows the noise.
    Status raise_to_noise(State& state);
    //! Repeats the first round with more fairness in quads that fold: what folds in it, later
    //! rounds hardly unfold. Parameters whose speed varies much make surfaces of few pieces
    //! overshoot. Ends: a quad is raised at most most_raises times, and brought back once.
    Status raise_at_folds(State& state);
    //! Adds samples where those there were have slid away. Errors: cancelled.
    Status fill_gaps(State& state);
    //! Unfolds quads that fold after the last round, one by one, by more fairness there while all
    //! others keep their places, and adds a round to the summary. No quad gets farther from its
    //! samples than the farthest was, or where there is emphasis than twice that or it was.
    Status unfold(State& state, double start);
    //! The state after the moves of regions that help; sets which are out. `most`: per quad the
    //! largest distance that is allowed. Errors: cancelled.
    Result<State> eased(const State& state, const LocalSystem& local,
                        std::vector<FoldEasing::Region>& regions,
                        const std::vector<double>& most) const;
    //! Like `moved`, after shortening the moves of regions that do not help.
    State moved_in_regions(const State& state, std::vector<FoldEasing::Region>& regions,
                           std::vector<Vec3>& move) const;
    std::vector<double> largest_distances(const State& state) const; //!< Per quad.
    double rms_distance(const State& state) const;
    void apply_fairness();
    //! Takes the feet as the new places of the samples, and of the normals that curls are known by.
    //! \return how many samples have crossed into another quad.
    Index take_feet(State& state);
    void record(State& state, double mu, double start);

    const SplineNetwork& network_;
    const ReducedNetwork& reduced_;
    const FitOptions& options_;
    Context& context_;
    NormalSystem system_;
    std::vector<double> row_weights_; //!< Per sample.
    std::vector<char> in_plane_;      //!< Per sample: see in_plane_quads().
    std::vector<double> quad_share_;  //!< Per quad: its rows' share of the weight, over 16.
    std::vector<double> floor_;       //!< Per quad: least fairness.
    std::vector<double> level_;       //!< Per quad: this round's fairness.
    std::vector<double> last_level_;  //!< Per quad: the fairness of the round before.
    std::vector<double> fairness_;    //!< Per quad: this round's factor of its energy.
    double round_fairness_ = 0.0;     //!< Of the quads without a floor of their own.
    FoldGuard guard_;
    FoldResponse response_;
    bool coupled_affordable_ = true;
};

} // namespace bot2nurbs
