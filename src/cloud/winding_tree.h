// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/vec.h"

#include <vector>

namespace bot2nurbs {

//! Three numbers a point, in the order of a WindingTree.
struct VectorField {
    std::vector<float> x, y, z;

    explicit VectorField(std::size_t n = 0) : x(n), y(n), z(n) {}
    std::size_t size() const { return x.size(); }
};
using ScalarField = std::vector<float>;

//! Sums over all pairs of points of the kernel of winding numbers, in O(n log n) by a tree:
//! far groups of points act through their sums and first moments \cite barill_2018.
//!
//! A point p with dipole m (area times outward normal) adds m . k(p - x) to the winding number at
//! x, with k(r) = r / (4 pi |r|^3): over the points of a closed surface this is 1 inside and 0
//! outside. Between points at distance d the kernel is softened: |r|^2 becomes d^2 + (w_1^2 +
//! w_2^2) / 2 with their widths w. Results are the same for any thread count.
class WindingTree {
public:
    //! Distances are taken in units of `unit`, so that single precision is enough. Cost
    //! O(n log n). Errors: cancelled. \pre at least one point
    static Result<WindingTree> build(const std::vector<Vec3>& points, double unit,
                                     Context& context);

    //! order()[i] is the number of the point that is i-th in fields.
    const std::vector<Index>& order() const { return order_; }
    std::size_t size() const { return order_.size(); }
    //! Softening widths for all sums from here on, by the numbers of the points.
    void set_widths(const std::vector<double>& widths);

    //! Winding numbers at the points.
    void winding(const VectorField& dipoles, ScalarField& result, const Context& context) const;
    //! The transpose of `winding`: sum over i of charge_i k(p - p_i) at every point p.
    void adjoint(const ScalarField& charges, VectorField& result, const Context& context) const;
    //! The gradient of the winding number, negated: it points outward where dipoles do.
    void outward(const VectorField& dipoles, VectorField& result, const Context& context) const;

private:
    struct Node {
        float x = 0, y = 0, z = 0; //!< Mean of its points.
        float radius = 0;          //!< Of a ball around it that holds them.
        Index begin = 0, end = 0;  //!< Its points.
        Index child = 0;           //!< The first of two; 0 for a leaf.
    };
    //! For each leaf: the leaves whose points, and the nodes whose moments, act on it.
    struct Interactions {
        std::vector<Index> leaves, nodes;
    };
    struct DipoleMoments;
    struct ChargeMoments;

    void build_nodes(std::vector<Index>& order, const std::vector<Vec3>& positions);
    bool find_interactions(const Context& context);
    DipoleMoments dipole_moments(const VectorField& dipoles) const;
    ChargeMoments charge_moments(const ScalarField& charges) const;
    template <class Sources, class Store>
    void sum(const Sources& sources, const Context& context, const Store& store) const;

    std::vector<Index> order_;
    std::vector<float> x_, y_, z_; //!< Of the points, moved and in units.
    std::vector<float> softening_; //!< Half the squared width.
    Vec3 origin_;
    double unit_ = 1.0;
    std::vector<Node> nodes_;
    std::vector<Index> leaves_;
    std::vector<Interactions> interactions_; //!< Per leaf.
};

} // namespace bot2nurbs
