// SPDX-License-Identifier: MIT
#include "network_fixtures.h"

#include <Eigen/Cholesky>

namespace bot2nurbs {
namespace {

using namespace fixtures;

std::vector<Domain> all_domains()
{
    std::vector<Domain> out = closed_domains();
    for (auto list : {open_domains(), feature_domains()}) {
        out.insert(out.end(), list.begin(), list.end());
    }
    return out;
}

Eigen::MatrixXd dense(const SparseRows& rows, Index columns)
{
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows.row_count(), columns);
    for (Index r = 0; r < rows.row_count(); ++r) {
        for (std::size_t i = rows.offset[r]; i < rows.offset[r + 1]; ++i) {
            out(r, rows.column[i]) = rows.weight[i];
        }
    }
    return out;
}

//! Rank of a Gram matrix by pivoted Cholesky factors. Its zero pivots come out below 1e-12, and the
//! others of the systems here above 1e-4.
Index gram_rank(const Eigen::MatrixXd& gram)
{
    const Eigen::LDLT<Eigen::MatrixXd> factors(gram);
    return static_cast<Index>((factors.vectorD().array() > 1e-9).count());
}

//! Rank of the map from unknowns that satisfy the constraints to Bezier coefficients.
Index rank_of(const SplineNetwork& network)
{
    Eigen::MatrixXd b = dense(network.stencils, network.unknown_count);
    if (network.constraints.row_count() > 0) {
        // Columns of the projection onto the constraints' kernel span it; supports are disjoint.
        const Eigen::MatrixXd c = dense(network.constraints, network.unknown_count);
        const Eigen::VectorXd inverse = c.rowwise().squaredNorm().cwiseInverse();
        b -= b * c.transpose() * inverse.asDiagonal() * c;
    }
    return gram_rank(b.transpose() * b);
}

TEST(SplineNetwork, rows_are_sorted_sum_to_one_and_hold_no_zeros)
{
    for (const Domain& d : all_domains()) {
        for (const SplineNetwork& network : networks_of(d)) {
            ASSERT_EQ(network.stencils.row_count(), 169 * d.complex.quad_count());
            ASSERT_EQ(network.is_point.size(), network.unknown_count);
            std::vector<char> used(network.unknown_count, 0);
            for (Index r = 0; r < network.stencils.row_count(); ++r) {
                double sum = 0.0;
                for (std::size_t i = network.stencils.offset[r]; i < network.stencils.offset[r + 1];
                     ++i) {
                    const Index c = network.stencils.column[i];
                    ASSERT_LT(c, network.unknown_count);
                    if (i > network.stencils.offset[r]) {
                        EXPECT_LT(network.stencils.column[i - 1], c);
                    }
                    EXPECT_GT(std::fabs(network.stencils.weight[i]), 1e-15);
                    sum += network.is_point[c] ? network.stencils.weight[i] : 0.0;
                    used[c] = 1;
                }
                EXPECT_NEAR(sum, 1.0, 2e-15) << d.name << " row " << r;
            }
            EXPECT_EQ(std::count(used.begin(), used.end(), 0), 0) << d.name;
        }
    }
}

TEST(SplineNetwork, both_patches_of_an_edge_have_identical_rows_along_it)
{
    for (const Domain& d : all_domains()) {
        const QuadComplex& k = d.complex;
        for (const SplineNetwork& network : networks_of(d)) {
            const SparseRows& s = network.stencils;
            const auto row_at = [](Index h, Index along) {
                const auto [i, j] = from_side(QuadComplex::side_of(h), along, 0, 12);
                return SplineNetwork::row(QuadComplex::quad_of(h), i, j);
            };
            for (Index h = 0; h < k.halfedge_count(); ++h) {
                if (k.twin(h) == invalid_index)
                    continue;
                for (Index j = 0; j < 13; ++j) {
                    const Index a = row_at(h, j), b = row_at(k.twin(h), 12 - j);
                    const std::size_t n = s.offset[a + 1] - s.offset[a];
                    ASSERT_EQ(n, s.offset[b + 1] - s.offset[b]);
                    for (std::size_t i = 0; i < n; ++i) {
                        EXPECT_EQ(s.column[s.offset[a] + i], s.column[s.offset[b] + i]);
                        EXPECT_EQ(s.weight[s.offset[a] + i], s.weight[s.offset[b] + i]);
                    }
                }
            }
        }
    }
}

TEST(SplineNetwork, all_patches_at_a_vertex_share_its_position_to_the_bit)
{
    for (const Domain& d : all_domains()) {
        for (const SplineNetwork& network : networks_of(d)) {
            const SplineSurface s(network, random_unknowns(network, 1));
            for (Index h = 0; h < d.complex.halfedge_count(); ++h) {
                const Index v = d.complex.from(h);
                EXPECT_EQ(local_bezier(s, h, 0, 0),
                          local_bezier(s, d.complex.halfedge_at(v), 0, 0));
            }
        }
    }
}

TEST(SplineNetwork, of_two_quads_at_a_vertex_exists_only_between_two_creases)
{
    const Domain torus = torus_grid(6, 5);
    auto quads = torus.complex.quads();
    const auto [a, b, c, d] = quads[0];
    const Index m = torus.complex.vertex_count();
    quads[0] = {a, b, c, m};
    quads.push_back({a, m, c, d});
    using Creases = std::vector<std::pair<Index, Index>>;
    for (const Creases& creases : {Creases{}, Creases{{a, m}}, Creases{{a, m}, {m, c}}}) {
        const Result<QuadComplex> complex = QuadComplex::build(m + 1, quads, creases);
        ASSERT_TRUE(complex.ok()) << complex.error().message;
        const Result<SplineNetwork> network = build_spline_network(*complex, SplineScheme::peters);
        EXPECT_EQ(network.ok(), creases.size() == 2);
    }
}

TEST(SplineNetwork, constraints_are_one_row_per_even_valence_above_four_with_disjoint_supports)
{
    for (const Domain& d : closed_domains()) {
        for (SplineScheme scheme : {SplineScheme::peters, SplineScheme::eck_hoppe}) {
            const SplineNetwork network = network_of(d, scheme);
            Index even = 0, entries = 0;
            for (Index v = 0; v < d.complex.vertex_count(); ++v) {
                const Index n = d.complex.valence(v);
                if (n > 4 && n % 2 == 0) {
                    ++even;
                    entries += 2 * n;
                }
            }
            EXPECT_EQ(network.constraints.row_count(), even) << d.name;
            EXPECT_EQ(network.constraints.column.size(), entries) << d.name;
            const std::set<Index> columns(network.constraints.column.begin(),
                                          network.constraints.column.end());
            EXPECT_EQ(columns.size(), entries) << d.name;
            for (double w : network.constraints.weight)
                EXPECT_EQ(std::fabs(w), 1.0);
        }
    }
    for (const Domain& d : open_domains()) {
        const SplineNetwork network = network_of(d);
        Index even = 0;
        for (Index v = 0; v < d.complex.vertex_count(); ++v) {
            const Index n = d.complex.valence(v);
            even += n == 6 && !d.complex.is_boundary_edge(d.complex.edge(d.complex.halfedge_at(v)));
        }
        EXPECT_EQ(network.constraints.row_count(), even) << d.name;
    }
}

TEST(SplineNetwork, closed_domains_have_16_unknowns_a_quad_less_n_minus_3_at_valence_n_above_four)
{
    for (const Domain& d : closed_domains()) {
        const SplineNetwork network = network_of(d);
        Index expected = 16 * d.complex.quad_count();
        for (Index v = 0; v < d.complex.vertex_count(); ++v) {
            if (d.complex.valence(v) >= 5)
                expected -= d.complex.valence(v) - 3;
        }
        EXPECT_EQ(network.unknown_count - network.constraints.row_count(), expected) << d.name;
    }
    EXPECT_EQ(network_of(cube()).unknown_count, 96u);
    EXPECT_EQ(network_of(radial_bipyramid(5)).unknown_count, 236u);
    EXPECT_EQ(network_of(radial_bipyramid(6)).unknown_count, 284u);
}

TEST(SplineNetwork, boundaries_and_creases_add_their_own_unknowns)
{
    // Per quad 12, per sharp edge 2; a smooth vertex 2 + 2 a fan, a dart 4, a corner 1 + 1 a sharp
    // edge + 1 a fan.
    EXPECT_EQ(network_of(disk_grid(1, 1)).unknown_count, 12u + 4 * 2 + 4 * (1 + 2 + 1));
    EXPECT_EQ(network_of(disk_grid(2, 1)).unknown_count, 24u + 6 * 2 + 4 * 4 + 2 * 4);
    EXPECT_EQ(network_of(star(5)).unknown_count, 60u + 20 + 5 * 4 + 5 * 4 + 3);
    const Domain d = split_bipyramid(5);
    const std::vector<Index> e = neighbours(d.complex, 5);
    const Index plain = network_of(d).unknown_count;
    // The crease edge ends at a dart with 5 quads (3 unknowns before) and one with 4 (4 before).
    const Domain dart = with_features(d, "dart", {{5, e[0]}});
    const Index other = d.complex.valence(e[0]);
    ASSERT_EQ(other, 4u);
    EXPECT_EQ(network_of(dart).unknown_count, plain + 2 + (4 - 3) + (4 - 4));
    const Domain triple = with_features(d, "triple", {{5, e[0]}, {5, e[1]}, {5, e[3]}});
    EXPECT_EQ(network_of(triple).unknown_count, plain + 6 + (1 + 3 + 3) - 3);
}

TEST(SplineNetwork, no_unknown_is_redundant)
{
    std::vector<Domain> domains{cube(), torus_grid(3, 4), disk_grid(2, 2), star(5), star(6)};
    for (Index n : {5u, 6u, 8u})
        domains.push_back(radial_bipyramid(n));
    for (const Domain& d : feature_domains()) {
        if (d.complex.quad_count() <= 30)
            domains.push_back(d);
    }
    for (const Domain& d : domains) {
        for (SplineScheme scheme : {SplineScheme::peters, SplineScheme::eck_hoppe}) {
            const auto network = build_spline_network(d.complex, scheme);
            if (!network)
                continue; // the masks of 1996 on an open or creased domain
            EXPECT_EQ(rank_of(*network), network->unknown_count - network->constraints.row_count())
                << d.name;
        }
    }
}

//! Writes linear conditions on the 13 x 13 grids of all C1 macro patches that share their borders:
//! unknowns are the coefficients that remain when equal ones are merged and those at inner knots
//! replaced by the mean of their neighbours.
class RawConditions {
public:
    using Term = std::pair<double, Index>; //!< Weight and SplineNetwork::row.

    explicit RawConditions(const QuadComplex& k) : name_(169 * k.quad_count(), invalid_index)
    {
        for (Index h = 0; h < k.halfedge_count(); ++h) {
            for (Index j = 0; j < 13; ++j) {
                const Index place = at(h, j, 0), other = at(k.twin(h), 12 - j, 0);
                if (h > k.twin(h))
                    name_[place] = other; // resolved by the loop in merged()
            }
        }
        // A vertex has one name: that of its first quad corner.
        for (Index h = 0; h < k.halfedge_count(); ++h) {
            const Index first = k.halfedge_at(k.from(h));
            name_[at(h, 0, 0)] = h == first ? invalid_index : at(first, 0, 0);
        }
    }

    static Index at(Index h, Index along, Index depth)
    {
        const auto [i, j] = from_side(QuadComplex::side_of(h), along, depth, 12);
        return SplineNetwork::row(QuadComplex::quad_of(h), i, j);
    }

    void add(const std::vector<Term>& terms)
    {
        for (const auto& [w, place] : terms)
            add_term(w, place);
        ++rows_;
    }

    //! Number of unknowns less the rank of the conditions.
    Index kernel_dimension() const
    {
        const Index columns = static_cast<Index>(column_.size());
        Eigen::SparseMatrix<double> m(rows_, columns);
        m.setFromTriplets(entries_.begin(), entries_.end());
        return columns - gram_rank(Eigen::MatrixXd(m.transpose() * m));
    }

private:
    void add_term(double w, Index place)
    {
        const Index q = place / 169, i = place % 169 / 13, j = place % 13;
        for (const bool in_i : {true, false}) {
            const Index m = in_i ? i : j;
            if (m % 3 != 0 || m == 0 || m == 12)
                continue;
            const Index step = in_i ? 13 : 1;
            add_term(0.5 * w, 169 * q + 13 * i + j - step);
            add_term(0.5 * w, 169 * q + 13 * i + j + step);
            return;
        }
        while (name_[place] != invalid_index)
            place = name_[place];
        const Index next = static_cast<Index>(column_.size());
        entries_.emplace_back(rows_, column_.try_emplace(place, next).first->second, w);
    }

    std::vector<Index> name_;
    std::map<Index, Index> column_;
    std::vector<Eigen::Triplet<double>> entries_;
    Index rows_ = 0;
};

//! Dimension of the space of all C1 macro patches over a closed smooth domain that join with the
//! quadratic cross derivative law and whose pieces away from extraordinary vertices are
//! biquadratic, from the raw conditions: an independent count.
Index raw_dimension(const QuadComplex& k)
{
    RawConditions conditions(k);
    const auto at = RawConditions::at;
    for (Index h = 0; h < k.halfedge_count(); ++h) {
        const Index g = k.twin(h);
        const double c = fan_cosine(k.valence(k.from(h)));
        if (c != 0.0) {
            conditions.add(
                {{1, at(h, 3, 0)}, {-3, at(h, 2, 0)}, {3, at(h, 1, 0)}, {-1, at(h, 0, 0)}});
        }
        for (Index j = 0; j < 7; ++j) {
            std::vector<RawConditions::Term> law{
                {1, at(h, j, 1)}, {1, at(g, 12 - j, 1)}, {-2, at(h, j, 0)}};
            if (c != 0.0 && j == 0) { // (4 c / 3)(q1 - q0) = 2 c (x1 - x0)
                law.insert(law.end(), {{-2 * c, at(h, 1, 0)}, {2 * c, at(h, 0, 0)}});
            }
            if (c != 0.0 && j == 1) { // (4 c / 9)(x3 - q1), q1 = (3 x1 - x0) / 2
                const double s = 4.0 * c / 9.0;
                law.insert(law.end(),
                           {{-s, at(h, 3, 0)}, {1.5 * s, at(h, 1, 0)}, {-0.5 * s, at(h, 0, 0)}});
            }
            conditions.add(law);
        }
    }
    for (Index q = 0; q < k.quad_count(); ++q) {
        for (Index a = 0; a < 4; ++a) {
            for (Index b = 0; b < 4; ++b) {
                if (a % 3 == 0 && b % 3 == 0) {
                    const Index corner = a == 0 ? (b == 0 ? 0 : 3) : (b == 0 ? 1 : 2);
                    if (k.valence(k.quad(q)[corner]) != 4)
                        continue;
                }
                for (Index j = 0; j < 4; ++j) {
                    for (const bool in_i : {true, false}) {
                        const auto place = [&](Index m) {
                            return in_i ? SplineNetwork::row(q, 3 * a + m, 3 * b + j)
                                        : SplineNetwork::row(q, 3 * a + j, 3 * b + m);
                        };
                        conditions.add(
                            {{1, place(3)}, {-3, place(2)}, {3, place(1)}, {-1, place(0)}});
                    }
                }
            }
        }
    }
    return conditions.kernel_dimension();
}

TEST(SplineNetwork, is_the_whole_space_of_its_smoothness_conditions)
{
    for (const Domain& d : {cube(), radial_bipyramid(5)}) {
        EXPECT_EQ(raw_dimension(d.complex), network_of(d).unknown_count) << d.name;
    }
    // An even valence has one more vector, the alternating twist, which the scheme sets to zero:
    // two such vertices, and two constraints.
    const Domain six = radial_bipyramid(6);
    EXPECT_EQ(raw_dimension(six.complex), network_of(six).unknown_count - 2 + 2);
}

TEST(SplineNetwork, follows_affine_maps_of_its_unknowns)
{
    Random random(3);
    const Vec3 a = random.point(), b = random.point(), c = random.point(), t = random.point();
    const auto map = [&](const Vec3& p) { return Vec3{dot(a, p), dot(b, p), dot(c, p)}; };
    for (const Domain& d : all_domains()) {
        for (const SplineNetwork& network : networks_of(d)) {
            const std::vector<Vec3> x = random_unknowns(network, 2);
            std::vector<Vec3> y(x.size());
            for (std::size_t i = 0; i < x.size(); ++i)
                y[i] = map(x[i]) + double(network.is_point[i]) * t;
            const SplineSurface s(network, x), moved(network, y);
            for (std::size_t i = 0; i < s.bezier().size(); ++i) {
                EXPECT_LE(max_abs(moved.bezier()[i] - map(s.bezier()[i]) - t), 2e-14) << d.name;
            }
        }
    }
}

TEST(SplineNetwork, unknowns_in_a_plane_give_a_surface_in_it)
{
    for (const Domain& d : all_domains()) {
        for (const SplineNetwork& network : networks_of(d)) {
            std::vector<Vec3> x = random_unknowns(network, 2);
            for (std::size_t i = 0; i < x.size(); ++i) {
                x[i].z = 0.3 * x[i].x - 1.7 * x[i].y + (network.is_point[i] ? 0.9 : 0.0);
            }
            const SplineSurface s(network, x);
            for (const Vec3& p : s.bezier()) {
                EXPECT_NEAR(p.z, 0.3 * p.x - 1.7 * p.y + 0.9, 1e-14) << d.name;
            }
        }
    }
}

TEST(SplineNetwork, a_regular_grid_reproduces_linear_parameters)
{
    // The nearest surface to the bilinear patches is those patches, because they are in the space.
    const Domain d = disk_grid(3, 2);
    for (const SplineNetwork& network : networks_of(d)) {
        const SplineSurface s(network, bilinear_unknowns(network, d.positions));
        for (Index q = 0; q < s.patch_count(); ++q) {
            const Vec3 origin = d.positions[d.complex.quad(q)[0]];
            for (Index i = 0; i < 13; ++i) {
                for (Index j = 0; j < 13; ++j) {
                    EXPECT_LE(max_abs(s.bezier(q, i, j) - origin - Vec3{i / 12.0, j / 12.0, 0}),
                              1e-12);
                }
            }
        }
    }
}

TEST(SplineNetwork, normals_point_outward_where_quads_turn_outward)
{
    std::vector<Domain> domains{sphere_cube(0), sphere_cube(1)};
    for (Index n : {5u, 6u, 8u}) {
        domains.push_back(split_bipyramid(n));
        for (Vec3& p : domains.back().positions)
            p = normalized(p);
    }
    for (const Domain& d : domains) {
        for (SplineScheme scheme :
             {SplineScheme::peters, SplineScheme::eck_hoppe, SplineScheme::full}) {
            // The masks of 1996 fold at valence 8 on so coarse a domain.
            if (scheme == SplineScheme::eck_hoppe && d.complex.max_valence() > 6)
                continue;
            const SplineNetwork network = network_of(d, scheme);
            const SplineSurface s(network, bilinear_unknowns(network, d.positions));
            for (Index q = 0; q < s.patch_count(); ++q) {
                for (int i = 0; i <= 8; ++i) {
                    for (int j = 0; j <= 8; ++j) {
                        const SurfacePoint p = s.evaluate({q, i / 8.0, j / 8.0});
                        EXPECT_GT(dot(cross(p.du, p.dv), p.position), 0.0) << d.name;
                    }
                }
            }
        }
    }
}

TEST(SplineNetwork, does_not_depend_on_where_a_quad_starts)
{
    // Turning the corners of every quad turns its grid; the surface space stays the same: the same
    // rank when both sets of rows are put together.
    const Domain d = radial_bipyramid(5);
    Quads quads = d.complex.quads();
    for (std::size_t q = 0; q < quads.size(); ++q) {
        std::rotate(quads[q].begin(), quads[q].begin() + q % 4, quads[q].end());
    }
    const Domain turned = make_domain("turned", d.positions, quads);
    for (SplineScheme scheme : {SplineScheme::peters, SplineScheme::full}) {
        const SplineNetwork a = network_of(d, scheme), b = network_of(turned, scheme);
        const Eigen::MatrixXd ma = dense(a.stencils, a.unknown_count);
        const Eigen::MatrixXd mb = dense(b.stencils, b.unknown_count);
        Eigen::MatrixXd both(ma.rows(), ma.cols() + mb.cols());
        both.leftCols(ma.cols()) = ma;
        for (Index q = 0; q < quads.size(); ++q) {
            for (Index i = 0; i < 13; ++i) {
                for (Index j = 0; j < 13; ++j) {
                    const auto [x, y] = from_side(q % 4, i, j, 12);
                    both.row(SplineNetwork::row(q, x, y)).rightCols(mb.cols()) =
                        mb.row(SplineNetwork::row(q, i, j));
                }
            }
        }
        EXPECT_EQ(gram_rank(both.transpose() * both), a.unknown_count);
    }
}

TEST(SplineNetwork, inner_vertices_of_valence_2_are_refused_by_name)
{
    // A pillow: two quads with the same four corners.
    const Domain pillow = make_domain("pillow", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                      {{0, 1, 2, 3}, {3, 2, 1, 0}});
    for (SplineScheme scheme :
         {SplineScheme::peters, SplineScheme::eck_hoppe, SplineScheme::full}) {
        const auto built = build_spline_network(pillow.complex, scheme);
        ASSERT_FALSE(built.ok());
        EXPECT_EQ(built.error().code, ErrorCode::invalid_domain);
        EXPECT_EQ(built.error().element, 0u);
        EXPECT_NE(built.error().message.find("vertex 0 "), std::string::npos);
    }
}

TEST(SplineNetwork, regular_rows_stay_small)
{
    // A coefficient mixes at most four controls of a patch, each on a border the mean of two; only
    // the corner rows of extraordinary vertices are longer. Keeps assembly and fit linear.
    const Domain d = torus_grid(12, 10);
    const SplineNetwork network = network_of(d);
    for (Index r = 0; r < network.stencils.row_count(); ++r) {
        EXPECT_LE(network.stencils.offset[r + 1] - network.stencils.offset[r], 9u);
    }
    EXPECT_LE(network.stencils.column.size(), 5u * network.stencils.row_count());
}

} // namespace
} // namespace bot2nurbs
