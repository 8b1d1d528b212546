// SPDX-License-Identifier: MIT
//! The scheme full: its dimension, that it contains the scheme peters, and vectors computed
//! elsewhere. What it shares with other schemes is in the tests of networks and continuity.

#include "network_fixtures.h"
#include "spline/full_masks.h"

#include <Eigen/Cholesky>
#include <fstream>
#include <nlohmann/json.hpp>

namespace bot2nurbs {
namespace {

using namespace fixtures;
using Json = nlohmann::json;

std::vector<Domain> all_domains()
{
    std::vector<Domain> out = closed_domains();
    for (auto list : {open_domains(), feature_domains()})
        out.insert(out.end(), list.begin(), list.end());
    return out;
}

std::vector<Fan> fans_of(const QuadComplex& k)
{
    auto fans = find_fans(k, {});
    return fans ? std::move(*fans) : std::vector<Fan>();
}

//! The cosine in the cross derivative law of the edge that starts with each halfedge; 0 where the
//! law is that of a regular vertex, and for sharp edges, which have none.
std::vector<double> cosines(const QuadComplex& k)
{
    std::vector<double> c(k.halfedge_count(), 0.0);
    for (const Fan& fan : fans_of(k)) {
        const double cosine = std::cos(fan.alpha / fan.sector_count());
        for (Index i = 0; i < fan.sector_count(); ++i) {
            const Index h = fan.sectors[i];
            if (!k.is_sharp(k.edge(h)) && std::fabs(cosine) > 1e-12)
                c[h] = cosine;
        }
    }
    return c;
}

Index at(Index h, Index along, Index depth)
{
    const auto [i, j] = from_side(QuadComplex::side_of(h), along, depth, 12);
    return SplineNetwork::row(QuadComplex::quad_of(h), i, j);
}

//! Number of unknowns by kinds of vertices and edges.
Index counted_dimension(const QuadComplex& k)
{
    Index n = 36 * k.quad_count();
    const std::vector<Fan> fans = fans_of(k);
    for (std::size_t f = 0; f < fans.size(); ++f) {
        const Fan& fan = fans[f];
        const Index sectors = fan.sector_count();
        const bool first = f == 0 || fans[f - 1].vertex != fan.vertex;
        Index sharp = 0;
        for (Index h = k.halfedge_at(fan.vertex), start = h; h != invalid_index;) {
            sharp += k.is_sharp(k.edge(h));
            const Index next = k.rotate_ccw(h);
            if (next == invalid_index)
                ++sharp;
            h = next == start ? invalid_index : next;
        }
        switch (fan.kind) {
        case FanKind::closed: n += 3 + (sectors == 4); break; // even n > 4: one more, one less
        case FanKind::smooth: n += (first ? 2 : 0) + 2; break;
        case FanKind::dart: n += 4; break;
        case FanKind::corner: n += (first ? 1 + sharp : 0) + 1; break;
        }
    }
    const std::vector<double> c = cosines(k);
    for (Index e = 0; e < k.edge_count(); ++e) {
        const Index h = k.halfedge_of_edge(e), g = k.twin(h);
        if (k.is_sharp(e))
            n += 6 + 6 * (g == invalid_index ? 1 : 2);
        else
            n += 8 + (c[h] == 0.0 ? 2 : 1) + (c[g] == 0.0 ? 2 : 1);
    }
    return n;
}

TEST(FullNetwork, has_the_unknowns_of_the_formula_and_no_constraints)
{
    for (const Domain& d : all_domains()) {
        const SplineNetwork network = network_of(d, SplineScheme::full);
        EXPECT_EQ(network.unknown_count, counted_dimension(d.complex)) << d.name;
        EXPECT_EQ(network.constraints.row_count(), 0u) << d.name;
        EXPECT_TRUE(network.c1_inside);
    }
    // Counts of the reference implementation.
    EXPECT_EQ(network_of(cube(), SplineScheme::full).unknown_count, 360u);
    EXPECT_EQ(network_of(torus_grid(5, 4), SplineScheme::full).unknown_count, 64u * 20);
    EXPECT_EQ(network_of(disk_grid(2, 1), SplineScheme::full).unknown_count, 180u);
    EXPECT_EQ(network_of(radial_bipyramid(5), SplineScheme::full).unknown_count, 916u);
    EXPECT_EQ(network_of(radial_bipyramid(6), SplineScheme::full).unknown_count, 1098u);
}

//! Dimension of the space of all C1 macro patches over a domain that join with the quadratic cross
//! derivative law, from the law alone: the kernel of its linear conditions on the coefficients that
//! are left when equal ones are merged and inner knots are C1.
class RawSpace {
public:
    explicit RawSpace(const QuadComplex& k) : complex_(k), name_(169 * k.quad_count())
    {
        for (Index i = 0; i < name_.size(); ++i)
            name_[i] = i;
        for (Index h = 0; h < k.halfedge_count(); ++h)
            for (Index j = 0; k.twin(h) != invalid_index && j < 13; ++j)
                merge(at(h, j, 0), at(k.twin(h), 12 - j, 0));
    }

    Index dimension()
    {
        const std::vector<double> c = cosines(complex_);
        for (Index h = 0; h < complex_.halfedge_count(); ++h)
            if (!complex_.is_sharp(complex_.edge(h)))
                add_law(h, c[h]);
        for (const Fan& fan : fans_of(complex_))
            if (fan.kind == FanKind::smooth) { // the border runs straight through
                const Index first = fan.sectors.front(),
                            last = QuadComplex::prev(fan.sectors.back());
                add({{1, at(first, 1, 0)}, {1, at(last, 11, 0)}, {-2, at(first, 0, 0)}});
            }
        for (Index place = 0; place < name_.size(); ++place)
            if (inner_knot(place) == 0)
                column(root(place));
        const Index n = static_cast<Index>(column_.size());
        Eigen::SparseMatrix<double> m(rows_, n);
        m.setFromTriplets(entries_.begin(), entries_.end());
        const Eigen::LDLT<Eigen::MatrixXd> factors(Eigen::MatrixXd(m.transpose() * m));
        // Zero pivots come out below 1e-12, others above 1e-6.
        return n - static_cast<Index>((factors.vectorD().array() > 1e-9).count());
    }

private:
    using Terms = std::vector<std::pair<double, Index>>;

    void add_law(Index h, double c)
    {
        const Index g = complex_.twin(h);
        if (c != 0.0) // a quadratic factor leaves room for a quadratic curve only
            add({{1, at(h, 3, 0)}, {-3, at(h, 2, 0)}, {3, at(h, 1, 0)}, {-1, at(h, 0, 0)}});
        for (Index j = 0; j < 7; ++j) {
            Terms law{{1, at(h, j, 1)}, {1, at(g, 12 - j, 1)}, {-2, at(h, j, 0)}};
            if (j == 0)
                law.insert(law.end(), {{-2 * c, at(h, 1, 0)}, {2 * c, at(h, 0, 0)}});
            const double s = 4.0 * c / 9.0;
            if (j == 1)
                law.insert(law.end(),
                           {{-s, at(h, 3, 0)}, {1.5 * s, at(h, 1, 0)}, {-0.5 * s, at(h, 0, 0)}});
            add(law);
        }
    }
    void add(const Terms& terms)
    {
        for (const auto& [w, place] : terms)
            add_term(w, place);
        ++rows_;
    }
    //! The step to the neighbours that an inner knot is the mean of, or 0.
    static Index inner_knot(Index place)
    {
        const Index i = place % 169 / 13, j = place % 13;
        return i % 3 == 0 && i % 12 != 0 ? 13 : (j % 3 == 0 && j % 12 != 0 ? 1 : 0);
    }
    void add_term(double w, Index place)
    {
        if (const Index step = inner_knot(place)) {
            add_term(0.5 * w, place - step);
            add_term(0.5 * w, place + step);
        } else if (w != 0.0) {
            entries_.emplace_back(rows_, column(root(place)), w);
        }
    }
    Index root(Index place) const
    {
        while (name_[place] != place)
            place = name_[place];
        return place;
    }
    void merge(Index a, Index b) { name_[std::max(root(a), root(b))] = std::min(root(a), root(b)); }
    Index column(Index place)
    {
        return column_.try_emplace(place, static_cast<Index>(column_.size())).first->second;
    }

    const QuadComplex& complex_;
    std::vector<Index> name_;
    std::map<Index, Index> column_;
    std::vector<Eigen::Triplet<double>> entries_;
    Index rows_ = 0;
};

TEST(FullNetwork, is_the_whole_space_of_its_smoothness_conditions)
{
    std::vector<Domain> domains{
        cube(),  radial_bipyramid(5), radial_bipyramid(6), torus_grid(3, 3), star(5),
        star(6), disk_grid(2, 1)};
    for (Index sectors : {2u, 3u, 4u, 5u})
        domains.push_back(star_sectors(8, 1, sectors));
    for (const Domain& d : feature_domains())
        if (d.complex.quad_count() <= 15)
            domains.push_back(d);
    const Domain s = star(6);
    const std::vector<Index> e = neighbours(s.complex, 0);
    domains.push_back(with_features(s, "dart_star", {{0, e[0]}}));
    domains.push_back(with_features(s, "triple_star", {{0, e[0]}, {0, e[1]}, {0, e[3]}}));
    domains.push_back(with_features(s, "crease_star", {{0, e[0]}, {0, e[2]}}));
    for (const Domain& d : domains)
        EXPECT_EQ(network_of(d, SplineScheme::full).unknown_count, RawSpace(d.complex).dimension())
            << d.name;
}

TEST(FullNetwork, unknowns_are_recovered_from_the_coefficients)
{
    // So none of them is redundant.
    for (const Domain& d : all_domains()) {
        const SplineNetwork network = network_of(d, SplineScheme::full);
        const std::vector<Vec3> x = random_unknowns(network, 11);
        const auto recovered = recover_unknowns(network, SplineSurface(network, x));
        ASSERT_TRUE(recovered.ok()) << d.name;
        for (Index i = 0; i < network.unknown_count; ++i)
            ASSERT_LE(max_abs((*recovered)[i] - x[i]), 2e-14) << d.name << " unknown " << i;
    }
}

TEST(FullNetwork, contains_every_surface_of_the_scheme_peters)
{
    for (const Domain& d : all_domains()) {
        const SplineNetwork peters = network_of(d), full = network_of(d, SplineScheme::full);
        const SplineSurface s(peters, random_unknowns(peters, 12));
        const auto x = recover_unknowns(full, s);
        ASSERT_TRUE(x.ok()) << d.name;
        const SplineSurface same(full, *x);
        for (std::size_t i = 0; i < s.bezier().size(); ++i)
            ASSERT_LE(max_abs(same.bezier()[i] - s.bezier()[i]), 1e-14) << d.name << " row " << i;
    }
}

TEST(FullNetwork, a_first_row_that_is_not_opposite_on_both_sides_shows_as_a_kink)
{
    const Domain d = split_bipyramid(6);
    SplineNetwork network = network_of(d, SplineScheme::full);
    const Index h = 4;
    SparseRows& rows = network.stencils;
    const Index row = at(h, 7, 1);
    // Of the vectors in the row, the one that the row on the edge does not have.
    std::size_t vector = rows.offset[row + 1];
    while (network.is_point[rows.column[--vector]]) {
    }
    rows.weight[vector] *= -1.0;
    const Continuity c =
        measure_continuity(d.complex, SplineSurface(network, random_unknowns(network, 13)));
    EXPECT_GT(c.max_g1_angle_deg, 1.0);
    EXPECT_EQ(c.worst_edge, d.complex.edge(h));
    EXPECT_EQ(c.max_gap, 0.0);
}

TEST(FullNetwork, recovery_says_what_it_cannot_do)
{
    const SplineNetwork peters = network_of(cube()), full = network_of(cube(), SplineScheme::full);
    const SplineSurface s(peters, random_unknowns(peters, 1));
    EXPECT_EQ(recover_unknowns(peters, s).error().code, ErrorCode::bad_option);
    const SplineNetwork other = network_of(star(5), SplineScheme::full);
    EXPECT_EQ(recover_unknowns(other, s).error().code, ErrorCode::invalid_domain);
    EXPECT_TRUE(recover_unknowns(full, s).ok());
}

TEST(FullNetwork, rows_stay_small)
{
    // Two unknowns make a coefficient next to a smooth edge, four where inner knots cross; the rows
    // at extraordinary vertices are longer. Keeps assembly and fit linear.
    const Domain d = torus_grid(12, 10);
    const SplineNetwork network = network_of(d, SplineScheme::full);
    EXPECT_LE(network.stencils.column.size(), 3u * network.stencils.row_count());
}

TEST(FullNetwork, equals_the_shared_vectors)
{
    std::ifstream in(std::string(BOT2NURBS_SHARED) + "/oracle/vectors_full.json");
    if (!in)
        GTEST_SKIP() << "no vectors_full.json beside this checkout";
    const Json all = Json::parse(in);
    int seen = 0;
    for (const Json& v : all["cases"]) {
        if (v["lambda_profile"] != "q")
            continue; // another cross derivative law
        ++seen;
        const std::string name = v["name"];
        const Quads quads = v["faces"];
        Index vertices = 0;
        for (const auto& q : quads)
            vertices = std::max(vertices, *std::max_element(q.begin(), q.end()) + 1);
        const Domain d = make_domain(name, std::vector<Vec3>(vertices), quads, v["crease"],
                                     v["corners"].get<std::vector<Index>>());
        const SplineNetwork network = network_of(d, SplineScheme::full);
        EXPECT_EQ(network.unknown_count, v["unknowns"].size()) << name;
        // A surface of random unknowns from there must be one of ours.
        std::vector<Vec3> bezier;
        for (const Json& patch : v["bezier"])
            for (const Json& row : patch)
                for (const Json& p : row)
                    bezier.push_back({p[0], p[1], p[2]});
        SplineSurface s(network, random_unknowns(network, 1));
        ASSERT_EQ(s.bezier().size(), bezier.size());
        s.bezier() = bezier;
        const auto x = recover_unknowns(network, s);
        ASSERT_TRUE(x.ok());
        const SplineSurface same(network, *x);
        for (std::size_t i = 0; i < bezier.size(); ++i)
            ASSERT_LE(max_abs(same.bezier()[i] - bezier[i]), 3e-14) << name << " row " << i;
    }
    EXPECT_EQ(seen, 10);
}

} // namespace
} // namespace bot2nurbs
