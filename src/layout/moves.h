// SPDX-License-Identifier: MIT
#pragma once

#include "layout/face_energy.h"
#include "layout/patch_complex.h"
#include "layout/valences.h"

#include <optional>
#include <utility>
#include <vector>

namespace bot2nurbs {

//! A local change of K_tri or K that may be worth making.
struct Move {
    enum class Kind {
        rotate,     //!< The path of `at` joins other corners of the disk of its two faces.
        straighten, //!< The path of `at` is drawn anew in the disk of its two faces.
        collapse,   //!< The start of `at` goes; its edges move to the opposite corner of its face.
        merge,      //!< The start of `at`, a vertex of degree two, goes: its two faces become one.
        relocate,   //!< The start of `at` moves to the middle of its star.
    };
    Kind kind = Kind::rotate;
    PatchComplex::Side at;
    Index turn = 1; //!< Rotate: by how many corners.
};

//! What a move would do: found from a state without changing it, so by many threads at once.
struct Proposal {
    PatchComplex::Change change;
    std::vector<FaceEnergy> energies;            //!< Of the faces it makes.
    double energy_change = 0.0;                  //!< Of the faces alone.
    std::vector<std::pair<Index, int>> valences; //!< Vertices whose valence changes, and by what.
    Index gone = invalid_index;                  //!< A vertex that is none afterwards.
    Index moved_to = invalid_index;              //!< The mesh vertex that takes its place.
};

//! K_tri or K with what is known of its faces and vertices.
struct ComplexState {
    PatchComplex& complex;
    Index sides; //!< Of every face.
    const SizeMetric& metric;
    Valences valences;
    std::vector<FaceEnergy> energies; //!< Per face.
};

//! By how much a proposal changes the valence terms, given the valences now.
double valence_change(const ComplexState& state, const Proposal& proposal);

//! Whether the topology allows a proposal now: its faces are there, no vertex gets too many or too
//! few edges, no two vertices get a second common edge.
bool is_possible(const ComplexState& state, const Proposal& proposal);

//! Works out a move. Empty when it is impossible, or cannot lower the sum of energies, valence
//! terms and -`credit` by more than `least_gain`, as far as is known before maps are made.
std::optional<Proposal> propose(const ComplexState& state, const Move& move, double credit,
                                double least_gain, OverlayBuilder& builder);

} // namespace bot2nurbs
