// SPDX-License-Identifier: MIT
//
// Kazhdan, Hoppe, Screened Poisson Surface Reconstruction, 2013. Differs from the paper: trilinear
// elements that are continuous across levels in place of B-splines that are solved level by level,
// conjugate gradients on all levels together in place of a cascade, and a function that vanishes
// on the border of the cube.
#include "cloud/poisson_system.h"

#include "cloud/octree_hats.h"

#include <cmath>

namespace bot2nurbs {

namespace {

using Corners = OctreeHats::Corners;

//! The surface is a level set: its place is settled long before the last digits of the function.
constexpr double residual_limit = 1e-3;
constexpr int most_iterations = 60;
constexpr std::size_t values_per_chunk = 16384;
constexpr std::size_t samples_per_poll = 65536;

//! Integrals over the unit interval of products of the two linear functions and their derivatives.
constexpr double mass(int a, int b)
{
    return a == b ? 1.0 / 3.0 : 1.0 / 6.0;
}
constexpr double stiffness(int a, int b)
{
    return a == b ? 1.0 : -1.0;
}
constexpr double slope(int a)
{
    return a == 0 ? -0.5 : 0.5; // of a's derivative with either function
}

//! Over the unit cell: gradient with gradient, and each derivative with the function itself.
struct ElementMatrices {
    double laplace[8][8] = {};
    double derivative[3][8][8] = {};

    constexpr ElementMatrices()
    {
        for (int a = 0; a < 8; ++a)
            for (int b = 0; b < 8; ++b)
                for (int axis = 0; axis < 3; ++axis) {
                    double grad = 1.0, part = 1.0;
                    for (int k = 0; k < 3; ++k) {
                        const int i = a >> k & 1, j = b >> k & 1;
                        grad *= k == axis ? stiffness(i, j) : mass(i, j);
                        part *= k == axis ? slope(i) : mass(i, j);
                    }
                    laplace[a][b] += grad;
                    derivative[axis][a][b] = part;
                }
    }
};
constexpr ElementMatrices element;

//! Values of the trilinear functions of a cell at a place in it.
Corners shape(const Vec3& t)
{
    Corners w;
    for (int k = 0; k < 8; ++k)
        w[static_cast<std::size_t>(k)] = ((k & 1) != 0 ? t.x : 1.0 - t.x) *
                                         ((k & 2) != 0 ? t.y : 1.0 - t.y) *
                                         ((k & 4) != 0 ? t.z : 1.0 - t.z);
    return w;
}

double dot8(const Corners& a, const Corners& b)
{
    double sum = 0.0;
    for (std::size_t k = 0; k < 8; ++k)
        sum += a[k] * b[k];
    return sum;
}

//! A place in a cell, from 0 to 1 an axis.
struct CellPlace {
    Index cell = 0;
    Vec3 t;
};

//! The samples of one cell as one: how the surface is held there.
struct Screen {
    Vec3 place; //!< In the cell, the mean.
    double weight = 0.0;
};

class PoissonSystem {
public:
    PoissonSystem(const Octree& tree, const std::vector<PoissonSample>& samples,
                  const Context& context)
        : tree_(tree), samples_(samples), context_(context), hats_(tree, context)
    {
    }

    Result<PoissonSolve> solve()
    {
        gather_screens();
        OctreeField right = right_side();
        make_diagonal();
        PoissonSolve result = conjugate_gradients(std::move(right));
        hats_.to_values(result.function.values);
        result.function.surface = value_at_samples(result.function.values);
        if (context_.cancelled())
            return Context::cancelled_error("reconstruction");
        return result;
    }

private:
    //! Runs use(level, place) over the cells that hold a point, from the root to a leaf.
    template <class Use> void for_each_cell(const Vec3& p, const Use& use) const
    {
        Index cell = 0;
        Vec3 t = p;
        for (int l = 0;; ++l) {
            use(l, CellPlace{cell, t});
            const OctreeLevel& level = tree_.level(l);
            if (level.is_leaf(cell))
                return;
            Index child = 0;
            for (int axis = 0; axis < 3; ++axis) {
                t[axis] *= 2.0;
                if (t[axis] >= 1.0) {
                    t[axis] -= 1.0;
                    child |= 1u << axis;
                }
            }
            cell = level.children[cell] + child;
        }
    }

    //! `use(sample)` for all, in their order.
    template <class Use> void for_each_sample(const Use& use) const
    {
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            if (i % samples_per_poll == 0 && context_.cancelled())
                return;
            use(samples_[i]);
        }
    }

    void gather_screens()
    {
        for (int l = 0; l <= tree_.depth(); ++l)
            screens_.emplace_back(tree_.level(l).cells.size());
        for_each_sample([&](const PoissonSample& s) {
            for_each_cell(s.position, [&](int l, const CellPlace& at) {
                Screen& screen = screens_[static_cast<std::size_t>(l)][at.cell];
                screen.place += s.weight * at.t;
                screen.weight += s.weight;
            });
        });
        for (auto& level : screens_)
            for (Screen& s : level)
                if (s.weight > 0.0)
                    s.place = s.place / s.weight;
    }

    //! The normals spread over the corners of the cells of their level.
    std::array<OctreeField, 3> inward_field()
    {
        std::array<OctreeField, 3> field{hats_.zeros(), hats_.zeros(), hats_.zeros()};
        for_each_sample([&](const PoissonSample& s) {
            for_each_cell(s.position, [&](int l, const CellPlace& at) {
                if (l != s.level)
                    return;
                const double h = Octree::cell_size(l), density = -s.area / (h * h * h);
                const Corners w = shape(at.t);
                for (Index k = 0; k < 8; ++k) {
                    const Index v = tree_.level(l).corners[8 * at.cell + k];
                    if (tree_.level(l).is_interior(v))
                        for (int axis = 0; axis < 3; ++axis)
                            field[static_cast<std::size_t>(axis)][static_cast<std::size_t>(l)][v] +=
                                density * w[k] * s.normal[axis];
                }
            });
        });
        for (OctreeField& component : field)
            hats_.to_values(component);
        return field;
    }

    OctreeField right_side()
    {
        const std::array<OctreeField, 3> inward = inward_field();
        OctreeField right = hats_.zeros();
        hats_.from_leaves(
            [&](int l, Index cell) {
                const double h = Octree::cell_size(l);
                Corners sums{};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const Corners v = corner_values(inward[axis], l, cell);
                    for (std::size_t a = 0; a < 8; ++a)
                        for (std::size_t b = 0; b < 8; ++b)
                            sums[a] += h * h * element.derivative[axis][a][b] * v[b];
                }
                const Screen& screen = screens_[static_cast<std::size_t>(l)][cell];
                if (screen.weight > 0.0) {
                    const Corners w = shape(screen.place);
                    for (std::size_t a = 0; a < 8; ++a)
                        sums[a] += 0.5 * screen.weight * w[a];
                }
                return sums;
            },
            right);
        return right;
    }

    Corners corner_values(const OctreeField& field, int l, Index cell) const
    {
        Corners values;
        for (Index k = 0; k < 8; ++k)
            values[k] = field[static_cast<std::size_t>(l)][tree_.level(l).corners[8 * cell + k]];
        return values;
    }

    //! Energies of the hats, inverted; zero without a hat.
    void make_diagonal()
    {
        inverse_diagonal_ = hats_.zeros();
        for (int l = 0; l <= tree_.depth(); ++l) {
            const OctreeLevel& level = tree_.level(l);
            const double h = Octree::cell_size(l);
            for_each_chunk(
                context_, level.vertex_count(), values_per_chunk,
                [&](std::size_t begin, std::size_t end) {
                    for (std::size_t i = begin; i < end; ++i) {
                        const Index v = static_cast<Index>(i);
                        if (!level.is_interior(v))
                            continue;
                        double energy = 8.0 * h * element.laplace[0][0];
                        for (Index s = level.first_slot[v]; s < level.first_slot[v + 1]; ++s) {
                            const Index slot = level.slots[s];
                            const Screen& screen = screens_[static_cast<std::size_t>(l)][slot / 8];
                            const double w = shape(screen.place)[slot % 8];
                            energy += screen.weight * w * w;
                        }
                        inverse_diagonal_[static_cast<std::size_t>(l)][v] = 1.0 / energy;
                    }
                });
        }
    }

    //! The system's matrix times coefficients of hats; `values` is for scratch.
    void apply(const OctreeField& coefficients, OctreeField& values, OctreeField& result)
    {
        values = coefficients;
        hats_.to_values(values);
        hats_.from_leaves(
            [&](int l, Index cell) {
                const double h = Octree::cell_size(l);
                const Corners v = corner_values(values, l, cell);
                Corners sums;
                for (std::size_t a = 0; a < 8; ++a) {
                    double sum = 0.0;
                    for (std::size_t b = 0; b < 8; ++b)
                        sum += element.laplace[a][b] * v[b];
                    sums[a] = h * sum;
                }
                const Screen& screen = screens_[static_cast<std::size_t>(l)][cell];
                if (screen.weight > 0.0) {
                    const Corners w = shape(screen.place);
                    const double f = screen.weight * dot8(w, v);
                    for (std::size_t a = 0; a < 8; ++a)
                        sums[a] += f * w[a];
                }
                return sums;
            },
            result);
    }

    //! Sum of a * b * c over all vertices of all levels.
    template <class Term> double sum(const Term& term) const
    {
        double total = 0.0;
        for (int l = 0; l <= tree_.depth(); ++l) {
            const std::size_t n = tree_.level(l).vertex_count();
            std::vector<double> parts((n + values_per_chunk - 1) / values_per_chunk, 0.0);
            for_each_chunk(context_, n, values_per_chunk, [&](std::size_t begin, std::size_t end) {
                double part = 0.0;
                for (std::size_t v = begin; v < end; ++v)
                    part += term(static_cast<std::size_t>(l), v);
                parts[begin / values_per_chunk] = part;
            });
            for (const double part : parts)
                total += part;
        }
        return total;
    }

    template <class Use> void for_each_value(const Use& use) const
    {
        for (int l = 0; l <= tree_.depth(); ++l)
            for_each_chunk(context_, tree_.level(l).vertex_count(), values_per_chunk,
                           [&](std::size_t begin, std::size_t end) {
                               for (std::size_t v = begin; v < end; ++v)
                                   use(static_cast<std::size_t>(l), v);
                           });
    }

    PoissonSolve conjugate_gradients(OctreeField r)
    {
        PoissonSolve result;
        OctreeField& x = result.function.values;
        x = hats_.zeros();
        OctreeField p = hats_.zeros(), q = hats_.zeros(), values;
        const OctreeField& d = inverse_diagonal_;
        double rho = sum([&](std::size_t l, std::size_t v) { return r[l][v] * d[l][v] * r[l][v]; });
        const double start = rho;
        double beta = 0.0;
        while (result.iterations < most_iterations && !context_.cancelled() &&
               rho > residual_limit * residual_limit * start) {
            for_each_value([&](std::size_t l, std::size_t v) {
                p[l][v] = d[l][v] * r[l][v] + beta * p[l][v];
            });
            apply(p, values, q);
            const double curvature =
                sum([&](std::size_t l, std::size_t v) { return p[l][v] * q[l][v]; });
            if (!(curvature > 0.0))
                break;
            const double alpha = rho / curvature;
            for_each_value([&](std::size_t l, std::size_t v) {
                x[l][v] += alpha * p[l][v];
                r[l][v] -= alpha * q[l][v];
            });
            const double last = rho;
            rho = sum([&](std::size_t l, std::size_t v) { return r[l][v] * d[l][v] * r[l][v]; });
            beta = rho / last;
            ++result.iterations;
        }
        result.residual = start > 0.0 ? std::sqrt(rho / start) : 0.0;
        return result;
    }

    //! The mean, by weight, of a function at the samples.
    double value_at_samples(const OctreeField& values) const
    {
        double total = 0.0, weight = 0.0;
        for (int l = 0; l <= tree_.depth(); ++l) {
            const OctreeLevel& level = tree_.level(l);
            for (Index c = 0; c < level.cell_count(); ++c) {
                const Screen& screen = screens_[static_cast<std::size_t>(l)][c];
                if (!level.is_leaf(c) || !(screen.weight > 0.0))
                    continue;
                total += screen.weight * dot8(shape(screen.place), corner_values(values, l, c));
                weight += screen.weight;
            }
        }
        return weight > 0.0 ? total / weight : 0.5;
    }

    const Octree& tree_;
    const std::vector<PoissonSample>& samples_;
    const Context& context_;
    OctreeHats hats_;
    std::vector<std::vector<Screen>> screens_; //!< Per level, per cell.
    OctreeField inverse_diagonal_;
};

} // namespace

Result<PoissonSolve> solve_poisson(const Octree& tree, const std::vector<PoissonSample>& samples,
                                   const Context& context)
{
    return PoissonSystem(tree, samples, context).solve();
}

} // namespace bot2nurbs
