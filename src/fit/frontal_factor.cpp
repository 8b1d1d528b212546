// SPDX-License-Identifier: MIT
#include "fit/frontal_factor.h"

#include "core/parallel.h"

#include <Eigen/Cholesky>
#include <atomic>

namespace bot2nurbs {

namespace {

using Size = Eigen::Index;

//! Columns eliminated between two polls of the context; a front of a thousand rows takes a few
//! milliseconds for them.
constexpr Size panel_columns = 48;
//! Columns of an update, or rows of a panel, that are one task of a large front.
constexpr Size task_lines = 96;

//! Where entry (a, c) of a symmetric block is among its values.
constexpr int block_entry[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

//! Runs body(begin, end) over [0, count) in tasks, side by side or one after another.
template <class Body> bool in_tasks(const Context& context, bool wide, Size count, const Body& body)
{
    const auto run = [&](std::size_t begin, std::size_t end) {
        body(static_cast<Size>(begin), static_cast<Size>(end));
    };
    if (wide)
        return for_each_chunk(context, static_cast<std::size_t>(count), task_lines, run);
    for (Size begin = 0; begin < count && !context.cancelled(); begin += task_lines)
        body(begin, std::min(count, begin + task_lines));
    return !context.cancelled();
}

//! lower triangle of `square` -= rows rows^T.
template <class Square, class Rows>
bool subtract_product(const Context& context, bool wide, Square&& square, const Rows& rows)
{
    const Size n = square.rows();
    return in_tasks(context, wide, n, [&](Size begin, Size end) {
        const Size w = end - begin, rest = n - end;
        square.block(begin, begin, w, w)
            .template selfadjointView<Eigen::Lower>()
            .rankUpdate(rows.middleRows(begin, w), -1);
        if (rest > 0)
            square.block(end, begin, rest, w).noalias() -=
                rows.bottomRows(rest) * rows.middleRows(begin, w).transpose();
    });
}

} // namespace

template <class Real> FrontalFactor<Real>::FrontalFactor(const FactorPlan& plan, int block)
    : plan_(&plan), block_(block)
{
}

template <class Real> auto FrontalFactor<Real>::panel(const FactorPlan::Supernode& node) -> Panel
{
    const std::size_t square = static_cast<std::size_t>(block_) * block_;
    return {values_.get() + node.values * square, Size(block_) * node.height(),
            Size(block_) * node.width()};
}

template <class Real> auto FrontalFactor<Real>::panel(const FactorPlan::Supernode& node) const
    -> ConstPanel
{
    const std::size_t square = static_cast<std::size_t>(block_) * block_;
    return {values_.get() + node.values * square, Size(block_) * node.height(),
            Size(block_) * node.width()};
}

template <class Real> template <class Body>
bool FrontalFactor<Real>::up_the_tree(const Context& context, const Body& body) const
{
    std::atomic<bool> ok{true};
    const auto& subtrees = plan_->subtrees;
    if (!for_each_chunk(context, subtrees.size(), 1, [&](std::size_t begin, std::size_t) {
            for (int s = subtrees[begin].first; s < subtrees[begin].last && ok; ++s)
                if (!body(s, false))
                    ok = false;
        }))
        return false;
    for (const int s : plan_->top)
        if (!ok || !body(s, true))
            return false;
    return ok;
}

template <class Real> template <class Body>
bool FrontalFactor<Real>::down_the_tree(const Context& context, const Body& body) const
{
    for (auto s = plan_->top.rbegin(); s != plan_->top.rend(); ++s)
        body(*s);
    const auto& subtrees = plan_->subtrees;
    return for_each_chunk(context, subtrees.size(), 1, [&](std::size_t begin, std::size_t) {
        for (int s = subtrees[begin].last - 1; s >= subtrees[begin].first; --s)
            body(s);
    });
}

template <class Real> bool FrontalFactor<Real>::factorize(const std::vector<double>& values,
                                                          const Eigen::VectorXd& scale,
                                                          const Context& context)
{
    if (!values_)
        values_.reset(new Real[plan_->value_count * static_cast<std::size_t>(block_) * block_]);
    // What the eliminated columns of a node leave for the others, until its parent takes it.
    std::vector<Matrix> updates(plan_->supernodes.size());
    return up_the_tree(context, [&](int s, bool wide) {
        assemble(s, values, scale, updates);
        return eliminate(s, updates[s], wide, context);
    });
}

template <class Real> void FrontalFactor<Real>::assemble(int s, const std::vector<double>& values,
                                                         const Eigen::VectorXd& scale,
                                                         std::vector<Matrix>& updates)
{
    const FactorPlan::Supernode& node = plan_->supernodes[s];
    const int b = block_, per_slot = b == 1 ? 1 : 6;
    Panel own = panel(node);
    own.setZero();
    Matrix& rest = updates[s];
    // Blocks above the diagonal are never read.
    rest.resize(Size(b) * node.row_count, Size(b) * node.row_count);
    for (Size j = 0; j < rest.cols(); j += b)
        rest.bottomRows(rest.rows() - j).middleCols(j, b).setZero();
    for (int j = node.first; j < node.last; ++j)
        for (int e = plan_->lower_column[j]; e < plan_->lower_column[j + 1]; ++e) {
            const int i = plan_->lower_row[e], at = plan_->lower_place[e];
            const double* v = &values[static_cast<std::size_t>(plan_->lower_slot[e]) * per_slot];
            for (int c = 0; c < b; ++c)
                for (int a = 0; a < b; ++a)
                    own(b * at + a, b * (j - node.first) + c) = static_cast<Real>(
                        v[block_entry[a][c]] * scale[b * i + a] * scale[b * j + c]);
        }
    for (const int child_number : node.children) {
        const FactorPlan::Supernode& child = plan_->supernodes[child_number];
        const Matrix& update = updates[child_number];
        const int* place = plan_->place_in_parent.data() + child.rows;
        for (int j = 0; j < child.row_count; ++j)
            for (int c = 0; c < b; ++c) {
                // Column of the parent: of its panel, or of what it leaves in turn.
                const int skipped = place[j] < node.width() ? 0 : node.width();
                Real* to = skipped == 0 ? &own(0, Size(b) * place[j] + c)
                                        : &rest(0, Size(b) * (place[j] - skipped) + c);
                const Real* from = &update(0, Size(b) * j + c);
                for (int i = j; i < child.row_count; ++i)
                    for (int a = 0; a < b; ++a)
                        to[b * (place[i] - skipped) + a] += from[b * i + a];
            }
        updates[child_number].resize(0, 0);
    }
}

//! Makes the panel of a node columns of the factor, and subtracts from `update` what they stand
//! for.
template <class Real>
bool FrontalFactor<Real>::eliminate(int s, Matrix& update, bool wide, const Context& context)
{
    Panel own = panel(plan_->supernodes[s]);
    const Size columns = own.cols(), rows = own.rows();
    for (Size k = 0; k < columns; k += panel_columns) {
        if (context.cancelled())
            return false;
        const Size w = std::min(panel_columns, columns - k), below = rows - k - w;
        auto corner = own.block(k, k, w, w);
        Eigen::Ref<Matrix> corner_ref(corner);
        const Eigen::LLT<Eigen::Ref<Matrix>> factor(corner_ref);
        if (factor.info() != Eigen::Success)
            return false;
        auto lower = own.block(k + w, k, below, w);
        in_tasks(context, wide, below, [&](Size begin, Size end) {
            auto part = lower.middleRows(begin, end - begin);
            corner.template triangularView<Eigen::Lower>()
                .transpose()
                .template solveInPlace<Eigen::OnTheRight>(part);
        });
        const Size right = columns - k - w; // columns of the panel that are still to come
        if (right > 0) {
            subtract_product(context, wide, own.block(k + w, k + w, right, right),
                             lower.topRows(right));
            if (below > right)
                in_tasks(context, wide, below - right, [&](Size begin, Size end) {
                    own.block(columns + begin, k + w, end - begin, right).noalias() -=
                        lower.middleRows(right + begin, end - begin) *
                        lower.topRows(right).transpose();
                });
        }
    }
    return rows == columns ||
           subtract_product(context, wide, update, own.bottomRows(rows - columns));
}

template <class Real> template <int Columns>
void FrontalFactor<Real>::solve(Eigen::Matrix<Real, Eigen::Dynamic, Columns>& x,
                                const Context& context) const
{
    using Vectors = Eigen::Matrix<Real, Eigen::Dynamic, Columns>;
    const Size b = block_;
    // What the solved unknowns of a node contribute to the rows below it, passed on to the parent.
    std::vector<Vectors> passed(plan_->supernodes.size());
    up_the_tree(context, [&](int s, bool) {
        const FactorPlan::Supernode& node = plan_->supernodes[s];
        const ConstPanel own_panel = panel(node);
        const Size w = own_panel.cols(), r = own_panel.rows() - w;
        auto own = x.middleRows(b * node.first, w);
        Vectors& up = passed[s];
        up.setZero(r, x.cols());
        for (const int child_number : node.children) {
            const FactorPlan::Supernode& child = plan_->supernodes[child_number];
            const Vectors& from = passed[child_number];
            const int* place = plan_->place_in_parent.data() + child.rows;
            for (Size c = 0; c < x.cols(); ++c)
                for (int i = 0; i < child.row_count; ++i)
                    for (Size a = 0; a < b; ++a) {
                        const Size to = b * place[i] + a;
                        (to < w ? own(to, c) : up(to - w, c)) += from(b * i + a, c);
                    }
            passed[child_number].resize(0, x.cols());
        }
        own_panel.topRows(w).template triangularView<Eigen::Lower>().solveInPlace(own);
        up.noalias() -= own_panel.bottomRows(r) * own;
        return true;
    });
    down_the_tree(context, [&](int s) {
        const FactorPlan::Supernode& node = plan_->supernodes[s];
        const ConstPanel own_panel = panel(node);
        const Size w = own_panel.cols(), r = own_panel.rows() - w;
        auto own = x.middleRows(b * node.first, w);
        const int* below = plan_->rows_below.data() + node.rows;
        Vectors known(r, x.cols());
        for (Size c = 0; c < x.cols(); ++c)
            for (int k = 0; k < node.row_count; ++k)
                for (Size a = 0; a < b; ++a)
                    known(b * k + a, c) = x(b * below[k] + a, c);
        own.noalias() -= own_panel.bottomRows(r).transpose() * known;
        own_panel.topRows(w).template triangularView<Eigen::Lower>().transpose().solveInPlace(own);
    });
}

template class FrontalFactor<float>;
template class FrontalFactor<double>;
template void FrontalFactor<float>::solve(Eigen::Matrix<float, Eigen::Dynamic, 1>&,
                                          const Context&) const;
template void FrontalFactor<double>::solve(Eigen::Matrix<double, Eigen::Dynamic, 1>&,
                                           const Context&) const;
template void FrontalFactor<double>::solve(Eigen::Matrix<double, Eigen::Dynamic, 3>&,
                                           const Context&) const;

} // namespace bot2nurbs
