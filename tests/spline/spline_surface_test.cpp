// SPDX-License-Identifier: MIT
#include "network_fixtures.h"
#include "spline/bernstein.h"

namespace bot2nurbs {
namespace {

using namespace fixtures;

SplineSurface random_surface(SplineScheme scheme = SplineScheme::peters)
{
    const SplineNetwork network = network_of(split_bipyramid(5), scheme);
    return SplineSurface(network, random_unknowns(network, 21));
}

//! Position by de Casteljau's construction: only midpoint-like sums, no Bernstein polynomial.
Vec3 de_casteljau(const SplineSurface& s, Index q, Index pu, Index pv, double tu, double tv)
{
    std::array<Vec3, 4> column;
    const auto collapse = [](std::array<Vec3, 4> c, double t) {
        for (int level = 3; level > 0; --level) {
            for (int i = 0; i < level; ++i)
                c[i] = (1 - t) * c[i] + t * c[i + 1];
        }
        return c[0];
    };
    for (Index a = 0; a < 4; ++a) {
        std::array<Vec3, 4> row;
        for (Index b = 0; b < 4; ++b)
            row[b] = s.bezier(q, 3 * pu + a, 3 * pv + b);
        column[a] = collapse(row, tv);
    }
    return collapse(column, tu);
}

TEST(Bernstein, values_sum_to_one_and_derivatives_to_zero)
{
    for (double t : {0.0, 0.1, 0.5, 0.77, 1.0}) {
        double value = 0.0, first = 0.0, second = 0.0;
        for (int i = 0; i < 4; ++i) {
            value += bernstein(t)[i];
            first += bernstein_d(t)[i];
            second += bernstein_dd(t)[i];
        }
        EXPECT_NEAR(value, 1.0, 1e-15);
        EXPECT_NEAR(first, 0.0, 1e-15);
        EXPECT_NEAR(second, 0.0, 1e-14);
    }
}

TEST(Bernstein, a_parameter_belongs_to_one_piece_and_the_last_piece_is_closed)
{
    for (Index p = 0; p < 4; ++p) {
        EXPECT_EQ(piece_parameter(p / 4.0).piece, p);
        EXPECT_EQ(piece_parameter(p / 4.0).t, 0.0);
        EXPECT_EQ(piece_parameter(std::nextafter((p + 1) / 4.0, 0.0)).piece, p);
    }
    EXPECT_EQ(piece_parameter(1.0).piece, 3u);
    EXPECT_EQ(piece_parameter(1.0).t, 1.0);
    EXPECT_EQ(piece_parameter(-0.1).piece, 0u);
    EXPECT_EQ(piece_parameter(1.1).piece, 3u);
}

TEST(Bernstein, the_basis_of_a_piece_gives_what_the_surface_evaluates)
{
    const SplineSurface s = random_surface();
    Random random(5);
    for (int k = 0; k < 200; ++k) {
        const double u = 0.5 + 0.5 * random.next(), v = 0.5 + 0.5 * random.next();
        const PieceBasis2 b = piece_basis2(u, v);
        const PieceBasis plain = piece_basis(u, v);
        EXPECT_EQ(plain.first_i, b.first_i);
        EXPECT_EQ(plain.first_j, b.first_j);
        SurfacePoint sum;
        for (Index a = 0; a < 16; ++a) {
            const Vec3 c = s.bezier(3, b.first_i + a / 4, b.first_j + a % 4);
            EXPECT_EQ(plain.value[a], b.value[a]);
            sum.position += b.value[a] * c;
            sum.du += b.du[a] * c;
            sum.dv += b.dv[a] * c;
            sum.duu += b.duu[a] * c;
            sum.duv += b.duv[a] * c;
            sum.dvv += b.dvv[a] * c;
        }
        const SurfacePoint p = s.evaluate({3, u, v});
        EXPECT_LE(norm(sum.position - p.position), 1e-14);
        EXPECT_LE(norm(s.position({3, u, v}) - p.position), 1e-14);
        EXPECT_LE(norm(sum.du - p.du) + norm(sum.dv - p.dv), 1e-12);
        EXPECT_LE(norm(sum.duu - p.duu) + norm(sum.duv - p.duv) + norm(sum.dvv - p.dvv), 1e-11);
    }
}

TEST(SplineSurface, evaluation_agrees_with_de_casteljau_in_every_piece)
{
    const SplineSurface s = random_surface();
    for (Index q = 0; q < s.patch_count(); ++q) {
        for (Index pu = 0; pu < 4; ++pu) {
            for (Index pv = 0; pv < 4; ++pv) {
                const Vec3 expected = de_casteljau(s, q, pu, pv, 0.3, 0.8);
                EXPECT_LE(norm(s.position({q, (pu + 0.3) / 4, (pv + 0.8) / 4}) - expected), 1e-14);
            }
        }
    }
}

TEST(SplineSurface, corners_are_interpolated_exactly)
{
    const SplineSurface s = random_surface();
    for (Index q = 0; q < s.patch_count(); ++q) {
        EXPECT_EQ(s.position({q, 0, 0}), s.bezier(q, 0, 0));
        EXPECT_EQ(s.position({q, 1, 0}), s.bezier(q, 12, 0));
        EXPECT_EQ(s.position({q, 1, 1}), s.bezier(q, 12, 12));
        EXPECT_EQ(s.position({q, 0, 1}), s.bezier(q, 0, 12));
    }
}

TEST(SplineSurface, derivatives_agree_with_central_differences)
{
    const SplineSurface s = random_surface();
    Random random(6);
    constexpr double h = 1e-4;
    for (int k = 0; k < 300; ++k) {
        const Index q = k % s.patch_count();
        // Stay inside a piece by more than the step.
        const auto inside = [&] {
            const double piece = std::floor(2.0 + 2.0 * random.next());
            return (std::fmin(piece, 3.0) + 0.5 + 0.49 * random.next()) / 4.0;
        };
        const double u = inside(), v = inside();
        const auto at = [&](double du, double dv) { return s.evaluate({q, u + du, v + dv}); };
        const SurfacePoint p = at(0, 0);
        const auto difference = [&](const Vec3& a, const Vec3& b) { return (a - b) / (2 * h); };
        // The central difference of a cubic is off by h^2 / 6 times its third derivative.
        EXPECT_LE(norm(difference(at(h, 0).position, at(-h, 0).position) - p.du), 1e-5);
        EXPECT_LE(norm(difference(at(0, h).position, at(0, -h).position) - p.dv), 1e-5);
        EXPECT_LE(norm(difference(at(h, 0).du, at(-h, 0).du) - p.duu), 1e-8);
        EXPECT_LE(norm(difference(at(0, h).du, at(0, -h).du) - p.duv), 1e-5);
        EXPECT_LE(norm(difference(at(h, 0).dv, at(-h, 0).dv) - p.duv), 1e-5);
        EXPECT_LE(norm(difference(at(0, h).dv, at(0, -h).dv) - p.dvv), 1e-8);
    }
}

TEST(SplineSurface, transform_scales_then_moves)
{
    SplineSurface s = random_surface();
    const SplineSurface before = s;
    s.transform(2.5, {1, -2, 3});
    for (double u : {0.0, 0.3, 0.8}) {
        const SurfacePoint a = before.evaluate({1, u, 0.4}), b = s.evaluate({1, u, 0.4});
        EXPECT_LE(norm(b.position - (2.5 * a.position + Vec3{1, -2, 3})), 1e-14);
        EXPECT_LE(norm(b.du - 2.5 * a.du), 1e-12);
    }
}

//! Values of all B-splines at t by Cox and de Boor, from an openNURBS knot vector.
std::vector<double> cox_de_boor(const BsplinePatch& patch, double t)
{
    std::vector<double> k = patch.knots;
    k.insert(k.begin(), k.front());
    k.push_back(k.back());
    std::vector<double> n(k.size() - 1, 0.0);
    for (std::size_t i = 0; i + 1 < k.size(); ++i) {
        const bool last = t == k.back() && k[i] < k[i + 1] && k[i + 1] == k.back();
        n[i] = (k[i] <= t && t < k[i + 1]) || last ? 1.0 : 0.0;
    }
    for (std::size_t d = 1; d <= 3; ++d) {
        for (std::size_t i = 0; i + 1 + d < k.size(); ++i) {
            const double left = k[i + d] - k[i], right = k[i + d + 1] - k[i + 1];
            n[i] = (left > 0 ? (t - k[i]) / left * n[i] : 0.0) +
                   (right > 0 ? (k[i + d + 1] - t) / right * n[i + 1] : 0.0);
        }
    }
    n.resize(patch.size);
    return n;
}

double worst_difference(const SplineSurface& s, KnotForm form)
{
    double worst = 0.0;
    for (Index q = 0; q < s.patch_count(); ++q) {
        const BsplinePatch patch = bspline_patch(s, q, form);
        for (double u : {0.0, 0.13, 0.25, 0.31, 0.5, 0.62, 0.75, 0.9, 1.0}) {
            const auto bu = cox_de_boor(patch, 4 * u);
            for (double v : {0.0, 0.07, 0.25, 0.44, 0.5, 0.7, 0.75, 0.99, 1.0}) {
                const auto bv = cox_de_boor(patch, 4 * v);
                Vec3 sum;
                for (Index i = 0; i < patch.size; ++i) {
                    for (Index j = 0; j < patch.size; ++j) {
                        sum += bu[i] * bv[j] * patch.control[i * patch.size + j];
                    }
                }
                worst = std::max(worst, norm(sum - s.position({q, u, v})));
            }
        }
    }
    return worst;
}

TEST(BsplinePatch, both_forms_are_the_surface_by_cox_de_boor)
{
    std::vector<Domain> domains{cube(), split_bipyramid(5), split_bipyramid(8), star(5), genus2()};
    for (const Domain& d : feature_domains())
        domains.push_back(d);
    for (const Domain& d : domains) {
        const SplineNetwork network = network_of(d);
        const SplineSurface s(network, random_unknowns(network, 22));
        EXPECT_LE(worst_difference(s, KnotForm::paper), 4e-15) << d.name;
        EXPECT_LE(worst_difference(s, KnotForm::c1), 4e-15) << d.name;
    }
}

TEST(BsplinePatch, the_masks_of_1996_need_the_form_with_triple_knots)
{
    const SplineSurface s = random_surface(SplineScheme::eck_hoppe);
    EXPECT_LE(worst_difference(s, KnotForm::paper), 4e-15);
    EXPECT_GT(worst_difference(s, KnotForm::c1), 1e-3);
}

TEST(BsplinePatch, knots_have_the_length_openNURBS_expects_and_clamped_ends)
{
    const SplineSurface s = random_surface();
    for (KnotForm form : {KnotForm::paper, KnotForm::c1}) {
        const BsplinePatch p = bspline_patch(s, 0, form);
        EXPECT_EQ(p.size, form == KnotForm::paper ? 12u : 10u);
        EXPECT_EQ(p.knots.size(), p.size + 2);
        EXPECT_EQ(p.control.size(), std::size_t(p.size) * p.size);
        EXPECT_TRUE(std::is_sorted(p.knots.begin(), p.knots.end()));
        for (int i = 0; i < 3; ++i) {
            EXPECT_EQ(p.knots[i], 0.0);
            EXPECT_EQ(p.knots[p.knots.size() - 1 - i], 4.0);
        }
        EXPECT_EQ(p.control.front(), s.bezier(0, 0, 0));
        EXPECT_EQ(p.control[p.size - 1], s.bezier(0, 0, 12));
        EXPECT_EQ(p.control.back(), s.bezier(0, 12, 12));
    }
}

TEST(BsplinePatch, neighbours_share_their_border_controls_to_the_bit)
{
    const Domain d = split_bipyramid(6);
    const QuadComplex& k = d.complex;
    const SplineNetwork network = network_of(d);
    SplineSurface s(network, random_unknowns(network, 23));
    s.transform(1234.5, {1e3, 2e3, -3e3});
    for (KnotForm form : {KnotForm::paper, KnotForm::c1}) {
        const auto border = [&](Index h) {
            const BsplinePatch p = bspline_patch(s, QuadComplex::quad_of(h), form);
            std::vector<Vec3> out;
            for (Index a = 0; a < p.size; ++a) {
                const auto [i, j] = from_side(QuadComplex::side_of(h), a, 0, p.size - 1);
                out.push_back(p.control[i * p.size + j]);
            }
            return out;
        };
        for (Index h = 0; h < k.halfedge_count(); ++h) {
            std::vector<Vec3> other = border(k.twin(h));
            std::reverse(other.begin(), other.end());
            EXPECT_TRUE(border(h) == other);
        }
    }
}

} // namespace
} // namespace bot2nurbs
