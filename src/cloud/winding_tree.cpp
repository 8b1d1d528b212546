// SPDX-License-Identifier: MIT
//
// Lin, Shi, Liu, Fast and Globally Consistent Normal Orientation based on the Winding Number Normal
// Consistency, 2024; Barill, Dickson, Schmidt, Levin, Jacobson, Fast Winding Numbers for Soups and
// Clouds, 2018.
#include "cloud/winding_tree.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace bot2nurbs {

namespace {

//! Points of a leaf. They are handled side by side, so this is a multiple of what processors take
//! at once.
constexpr std::size_t lanes = 16;
//! A node acts through its moments on points at least this many of its radii away: with first
//! moments the error of a node is then below a quarter of its share, and that of all of them, whose
//! signs differ, some thousandths.
constexpr float opening = 2.0f;
constexpr std::size_t leaves_per_chunk = 8;
constexpr double quarter_pi_inverse = 1.0 / (4.0 * 3.14159265358979323846);

using Lanes = std::array<float, lanes>;

//! The points of one leaf, side by side; lanes without a point repeat the last one.
struct Targets {
    Lanes x, y, z, softening;
};

} // namespace

//! Sums of dipoles m and of their first moments d m^T (symmetric part), d from the node's centre.
struct WindingTree::DipoleMoments {
    std::vector<float> mx, my, mz, xx, yy, zz, xy, xz, yz;

    explicit DipoleMoments(std::size_t n)
        : mx(n), my(n), mz(n), xx(n), yy(n), zz(n), xy(n), xz(n), yz(n)
    {
    }
    void shift(std::size_t to, std::size_t from, float dx, float dy, float dz)
    {
        add(to, mx[from], my[from], mz[from], dx, dy, dz);
        xx[to] += xx[from], yy[to] += yy[from], zz[to] += zz[from];
        xy[to] += xy[from], xz[to] += xz[from], yz[to] += yz[from];
    }
    void add(std::size_t to, float ax, float ay, float az, float dx, float dy, float dz)
    {
        mx[to] += ax, my[to] += ay, mz[to] += az;
        xx[to] += dx * ax, yy[to] += dy * ay, zz[to] += dz * az;
        xy[to] += 0.5f * (dx * ay + dy * ax);
        xz[to] += 0.5f * (dx * az + dz * ax);
        yz[to] += 0.5f * (dy * az + dz * ay);
    }
};

struct WindingTree::ChargeMoments {
    std::vector<float> charge, dx, dy, dz;

    explicit ChargeMoments(std::size_t n) : charge(n), dx(n), dy(n), dz(n) {}
};

Result<WindingTree> WindingTree::build(const std::vector<Vec3>& points, double unit,
                                       Context& context)
{
    WindingTree tree;
    tree.unit_ = unit;
    Box3 box;
    for (const Vec3& p : points)
        box.add(p);
    tree.origin_ = box.center();
    std::vector<Vec3> positions(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        positions[i] = (points[i] - tree.origin_) / unit;
    tree.order_.resize(points.size());
    std::iota(tree.order_.begin(), tree.order_.end(), Index{0});
    tree.build_nodes(tree.order_, positions);
    for (const Index i : tree.order_) {
        tree.x_.push_back(static_cast<float>(positions[i].x));
        tree.y_.push_back(static_cast<float>(positions[i].y));
        tree.z_.push_back(static_cast<float>(positions[i].z));
    }
    tree.softening_.assign(points.size(), 0.0f);
    if (context.cancelled() || !tree.find_interactions(context))
        return Context::cancelled_error("winding numbers");
    return tree;
}

void WindingTree::build_nodes(std::vector<Index>& order, const std::vector<Vec3>& positions)
{
    Node root;
    root.end = static_cast<Index>(order.size());
    nodes_.push_back(root);
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
        Node node = nodes_[n];
        Box3 box;
        Vec3 mean;
        for (Index i = node.begin; i < node.end; ++i) {
            box.add(positions[order[i]]);
            mean += positions[order[i]];
        }
        mean = mean / static_cast<double>(node.end - node.begin);
        double radius2 = 0.0;
        for (Index i = node.begin; i < node.end; ++i)
            radius2 = std::max(radius2, norm_squared(positions[order[i]] - mean));
        node.x = static_cast<float>(mean.x);
        node.y = static_cast<float>(mean.y);
        node.z = static_cast<float>(mean.z);
        node.radius = static_cast<float>(std::sqrt(radius2));
        if (node.end - node.begin > lanes) {
            const Vec3 side = box.max - box.min;
            const int axis = side.x >= side.y && side.x >= side.z ? 0 : (side.y >= side.z ? 1 : 2);
            const Index middle = node.begin + (node.end - node.begin) / 2;
            const auto at = [&](Index i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
            std::nth_element(at(node.begin), at(middle), at(node.end), [&](Index a, Index b) {
                const double u = positions[a][axis], v = positions[b][axis];
                return u < v || (u == v && a < b);
            });
            node.child = static_cast<Index>(nodes_.size());
            Node half;
            half.begin = node.begin;
            half.end = middle;
            nodes_.push_back(half);
            half.begin = middle;
            half.end = node.end;
            nodes_.push_back(half);
        } else {
            leaves_.push_back(static_cast<Index>(n));
        }
        nodes_[n] = node;
    }
}

bool WindingTree::find_interactions(const Context& context)
{
    interactions_.resize(leaves_.size());
    return for_each_chunk(context, leaves_.size(), leaves_per_chunk,
                          [&](std::size_t begin, std::size_t end) {
                              std::vector<Index> open;
                              for (std::size_t l = begin; l < end; ++l) {
                                  const Node& target = nodes_[leaves_[l]];
                                  Interactions& found = interactions_[l];
                                  open.assign(1, 0);
                                  while (!open.empty()) {
                                      const Index n = open.back();
                                      open.pop_back();
                                      const Node& node = nodes_[n];
                                      const float dx = node.x - target.x, dy = node.y - target.y,
                                                  dz = node.z - target.z;
                                      const float distance = std::sqrt(dx * dx + dy * dy + dz * dz);
                                      if (distance > opening * node.radius + target.radius) {
                                          found.nodes.push_back(n);
                                      } else if (node.child == 0) {
                                          found.leaves.push_back(n);
                                      } else {
                                          open.push_back(node.child + 1);
                                          open.push_back(node.child);
                                      }
                                  }
                              }
                          });
}

void WindingTree::set_widths(const std::vector<double>& widths)
{
    for (std::size_t i = 0; i < order_.size(); ++i) {
        const double w = widths[order_[i]] / unit_;
        softening_[i] = static_cast<float>(0.5 * w * w);
    }
}

WindingTree::DipoleMoments WindingTree::dipole_moments(const VectorField& dipoles) const
{
    DipoleMoments m(nodes_.size());
    // Children come behind their parents.
    for (std::size_t n = nodes_.size(); n-- > 0;) {
        const Node& node = nodes_[n];
        if (node.child == 0) {
            for (Index i = node.begin; i < node.end; ++i)
                m.add(n, dipoles.x[i], dipoles.y[i], dipoles.z[i], x_[i] - node.x, y_[i] - node.y,
                      z_[i] - node.z);
        } else {
            for (const Index c : {node.child, node.child + 1})
                m.shift(n, c, nodes_[c].x - node.x, nodes_[c].y - node.y, nodes_[c].z - node.z);
        }
    }
    return m;
}

WindingTree::ChargeMoments WindingTree::charge_moments(const ScalarField& charges) const
{
    ChargeMoments m(nodes_.size());
    for (std::size_t n = nodes_.size(); n-- > 0;) {
        const Node& node = nodes_[n];
        if (node.child == 0) {
            for (Index i = node.begin; i < node.end; ++i) {
                m.charge[n] += charges[i];
                m.dx[n] += charges[i] * (x_[i] - node.x);
                m.dy[n] += charges[i] * (y_[i] - node.y);
                m.dz[n] += charges[i] * (z_[i] - node.z);
            }
        } else {
            for (const Index c : {node.child, node.child + 1}) {
                m.charge[n] += m.charge[c];
                m.dx[n] += m.dx[c] + m.charge[c] * (nodes_[c].x - node.x);
                m.dy[n] += m.dy[c] + m.charge[c] * (nodes_[c].y - node.y);
                m.dz[n] += m.dz[c] + m.charge[c] * (nodes_[c].z - node.z);
            }
        }
    }
    return m;
}

//! Runs over the sources of every leaf: sources.point and sources.node add to the sums of the
//! targets, which `store` puts away.
template <class Sources, class Store>
void WindingTree::sum(const Sources& sources, const Context& context, const Store& store) const
{
    for_each_chunk(
        context, leaves_.size(), leaves_per_chunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t l = begin; l < end; ++l) {
                const Node& leaf = nodes_[leaves_[l]];
                Targets t;
                for (std::size_t k = 0; k < lanes; ++k) {
                    const Index i = std::min(leaf.begin + static_cast<Index>(k), leaf.end - 1);
                    t.x[k] = x_[i], t.y[k] = y_[i], t.z[k] = z_[i];
                    t.softening[k] = softening_[i];
                }
                typename Sources::Sums sums{};
                for (const Index n : interactions_[l].leaves)
                    for (Index i = nodes_[n].begin; i < nodes_[n].end; ++i)
                        sources.point(i, t, sums);
                for (const Index n : interactions_[l].nodes)
                    sources.node(n, t, sums);
                for (Index i = leaf.begin; i < leaf.end; ++i)
                    store(i, sums, i - leaf.begin);
            }
        });
}

void WindingTree::winding(const VectorField& dipoles, ScalarField& result,
                          const Context& context) const
{
    const DipoleMoments moments = dipole_moments(dipoles);
    struct Sources {
        struct Sums {
            Lanes w;
        };
        const WindingTree& tree;
        const VectorField& dipoles;
        const DipoleMoments& m;

        void point(Index i, const Targets& t, Sums& s) const
        {
            const float px = tree.x_[i], py = tree.y_[i], pz = tree.z_[i],
                        soft = tree.softening_[i];
            const float ax = dipoles.x[i], ay = dipoles.y[i], az = dipoles.z[i];
            for (std::size_t k = 0; k < lanes; ++k) {
                const float x = px - t.x[k], y = py - t.y[k], z = pz - t.z[k];
                const float r2 = x * x + y * y + z * z + soft + t.softening[k];
                const float r3 = r2 * std::sqrt(r2);
                // A point without softening does not act on itself.
                s.w[k] += r3 > 0.0f ? (ax * x + ay * y + az * z) / r3 : 0.0f;
            }
        }
        void node(Index n, const Targets& t, Sums& s) const
        {
            const Node& c = tree.nodes_[n];
            const float ax = m.mx[n], ay = m.my[n], az = m.mz[n];
            const float xx = m.xx[n], yy = m.yy[n], zz = m.zz[n];
            const float xy = 2 * m.xy[n], xz = 2 * m.xz[n], yz = 2 * m.yz[n];
            const float trace = xx + yy + zz;
            for (std::size_t k = 0; k < lanes; ++k) {
                const float x = c.x - t.x[k], y = c.y - t.y[k], z = c.z - t.z[k];
                const float r2 = x * x + y * y + z * z;
                const float i2 = 1.0f / r2, i3 = i2 * std::sqrt(i2);
                const float form =
                    x * (xx * x + xy * y + xz * z) + y * (yy * y + yz * z) + zz * z * z;
                s.w[k] += i3 * (ax * x + ay * y + az * z + trace - 3.0f * i2 * form);
            }
        }
    };
    result.resize(size());
    sum(Sources{*this, dipoles, moments}, context,
        [&](Index i, const Sources::Sums& s, std::size_t k) {
            result[i] = static_cast<float>(quarter_pi_inverse) * s.w[k];
        });
}

namespace {

//! A vector a lane.
struct VectorSums {
    Lanes x, y, z;
};

} // namespace

void WindingTree::adjoint(const ScalarField& charges, VectorField& result,
                          const Context& context) const
{
    const ChargeMoments moments = charge_moments(charges);
    struct Sources {
        using Sums = VectorSums;
        const WindingTree& tree;
        const ScalarField& charges;
        const ChargeMoments& m;

        void point(Index i, const Targets& t, Sums& s) const
        {
            const float px = tree.x_[i], py = tree.y_[i], pz = tree.z_[i],
                        soft = tree.softening_[i], charge = charges[i];
            for (std::size_t k = 0; k < lanes; ++k) {
                const float x = t.x[k] - px, y = t.y[k] - py, z = t.z[k] - pz;
                const float r2 = x * x + y * y + z * z + soft + t.softening[k];
                const float r3 = r2 * std::sqrt(r2);
                const float f = r3 > 0.0f ? charge / r3 : 0.0f;
                s.x[k] += f * x;
                s.y[k] += f * y;
                s.z[k] += f * z;
            }
        }
        void node(Index n, const Targets& t, Sums& s) const
        {
            const Node& c = tree.nodes_[n];
            const float charge = m.charge[n], dx = m.dx[n], dy = m.dy[n], dz = m.dz[n];
            for (std::size_t k = 0; k < lanes; ++k) {
                const float x = t.x[k] - c.x, y = t.y[k] - c.y, z = t.z[k] - c.z;
                const float r2 = x * x + y * y + z * z;
                const float i2 = 1.0f / r2, i3 = i2 * std::sqrt(i2);
                const float f = charge + 3.0f * i2 * (x * dx + y * dy + z * dz);
                s.x[k] += i3 * (f * x - dx);
                s.y[k] += i3 * (f * y - dy);
                s.z[k] += i3 * (f * z - dz);
            }
        }
    };
    result = VectorField(size());
    sum(Sources{*this, charges, moments}, context,
        [&](Index i, const VectorSums& s, std::size_t k) {
            constexpr auto f = static_cast<float>(quarter_pi_inverse);
            result.x[i] = f * s.x[k], result.y[i] = f * s.y[k], result.z[i] = f * s.z[k];
        });
}

void WindingTree::outward(const VectorField& dipoles, VectorField& result,
                          const Context& context) const
{
    const DipoleMoments moments = dipole_moments(dipoles);
    struct Sources {
        using Sums = VectorSums;
        const WindingTree& tree;
        const VectorField& dipoles;
        const DipoleMoments& m;

        void point(Index i, const Targets& t, Sums& s) const
        {
            const float px = tree.x_[i], py = tree.y_[i], pz = tree.z_[i],
                        soft = tree.softening_[i];
            const float ax = dipoles.x[i], ay = dipoles.y[i], az = dipoles.z[i];
            for (std::size_t k = 0; k < lanes; ++k) {
                const float x = px - t.x[k], y = py - t.y[k], z = pz - t.z[k];
                const float r2 = x * x + y * y + z * z + soft + t.softening[k];
                const float r3 = r2 * std::sqrt(r2);
                const float i3 = r3 > 0.0f ? 1.0f / r3 : 0.0f;
                const float f = r2 > 0.0f ? 3.0f * (ax * x + ay * y + az * z) / r2 : 0.0f;
                s.x[k] += i3 * (ax - f * x);
                s.y[k] += i3 * (ay - f * y);
                s.z[k] += i3 * (az - f * z);
            }
        }
        void node(Index n, const Targets& t, Sums& s) const
        {
            const Node& c = tree.nodes_[n];
            const float ax = m.mx[n], ay = m.my[n], az = m.mz[n];
            const float xx = m.xx[n], yy = m.yy[n], zz = m.zz[n];
            const float xy = m.xy[n], xz = m.xz[n], yz = m.yz[n];
            const float trace = xx + yy + zz;
            for (std::size_t k = 0; k < lanes; ++k) {
                const float x = c.x - t.x[k], y = c.y - t.y[k], z = c.z - t.z[k];
                const float r2 = x * x + y * y + z * z;
                const float i2 = 1.0f / r2, i3 = i2 * std::sqrt(i2);
                // The symmetric first moments times the direction.
                const float qx = xx * x + xy * y + xz * z, qy = xy * x + yy * y + yz * z,
                            qz = xz * x + yz * y + zz * z;
                const float form = qx * x + qy * y + qz * z;
                const float f = 3.0f * i2 * (ax * x + ay * y + az * z + trace - 5.0f * i2 * form);
                s.x[k] += i3 * (ax - f * x - 6.0f * i2 * qx);
                s.y[k] += i3 * (ay - f * y - 6.0f * i2 * qy);
                s.z[k] += i3 * (az - f * z - 6.0f * i2 * qz);
            }
        }
    };
    result = VectorField(size());
    sum(Sources{*this, dipoles, moments}, context,
        [&](Index i, const VectorSums& s, std::size_t k) {
            constexpr auto f = static_cast<float>(quarter_pi_inverse);
            result.x[i] = f * s.x[k], result.y[i] = f * s.y[k], result.z[i] = f * s.z[k];
        });
}

} // namespace bot2nurbs
