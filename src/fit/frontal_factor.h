// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "fit/factor_plan.h"

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace bot2nurbs {

//! A multifrontal Cholesky factor of a symmetric positive definite sparse matrix of symmetric
//! b x b blocks, b = 1 or 3, in float or double. All arithmetic is in dense kernels; subtrees of
//! the elimination tree run side by side, and so do parts of the large fronts above them. Same
//! bytes for any thread count.
template <class Real> class FrontalFactor {
public:
    //! The plan must outlive this.
    FrontalFactor(const FactorPlan& plan, int block);

    //! Factorises D A D. `values` has per slot of the plan 1 value, or 6 for the block xx, xy, xz,
    //! yy, yz, zz; `scale` is the diagonal of D. \return false when a pivot is not positive or the
    //! context was cancelled, which is polled at every panel.
    bool factorize(const std::vector<double>& values, const Eigen::VectorXd& scale,
                   const Context& context);
    //! Solves for every column of x, in place. \pre the last `factorize` returned true
    template <int Columns>
    void solve(Eigen::Matrix<Real, Eigen::Dynamic, Columns>& x, const Context& context) const;

private:
    using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
    using Panel = Eigen::Map<Matrix>;
    using ConstPanel = Eigen::Map<const Matrix>;

    Panel panel(const FactorPlan::Supernode& node);
    ConstPanel panel(const FactorPlan::Supernode& node) const;
    //! Runs body(node, wide) over all supernodes, children before parents or parents before
    //! children; `wide` is true for those whose own arithmetic may use several threads.
    template <class Body> bool up_the_tree(const Context& context, const Body& body) const;
    template <class Body> bool down_the_tree(const Context& context, const Body& body) const;
    void assemble(int node, const std::vector<double>& values, const Eigen::VectorXd& scale,
                  std::vector<Matrix>& updates);
    bool eliminate(int node, Matrix& update, bool wide, const Context& context);

    const FactorPlan* plan_;
    int block_;
    // Not set to zero beforehand: that would take as long as a cancelled call may, and panels are
    // when they are assembled.
    std::unique_ptr<Real[]> values_;
};

extern template class FrontalFactor<float>;
extern template class FrontalFactor<double>;

} // namespace bot2nurbs
