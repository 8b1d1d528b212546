// SPDX-License-Identifier: MIT
#include "spline/vertex_masks.h"

#include <cmath>
#include <gtest/gtest.h>
#include <string>

namespace bot2nurbs {
namespace {

struct Case {
    FanKind kind;
    Index sectors;
    double alpha;
    std::string name() const
    {
        static const char* kinds[] = {"closed", "smooth", "dart", "corner"};
        return std::string(kinds[static_cast<int>(kind)]) + " " + std::to_string(sectors) +
               " alpha " + std::to_string(alpha);
    }
    bool closed() const { return kind == FanKind::closed; }
    Index edges() const { return sectors + (closed() ? 0 : 1); }
    double cosine() const { return std::cos(alpha / sectors); }
};

std::vector<Case> peters_cases()
{
    std::vector<Case> out;
    for (Index n = 3; n <= 12; ++n)
        out.push_back({FanKind::closed, n, 2.0 * M_PI});
    for (Index k = 2; k <= 8; ++k)
        out.push_back({FanKind::smooth, k, M_PI});
    for (Index k = 3; k <= 8; ++k)
        out.push_back({FanKind::dart, k, 2.0 * M_PI});
    for (Index k = 1; k <= 6; ++k)
        out.push_back({FanKind::corner, k, corner_fan_angle(k)});
    // Angles other than the defaults, on either side of pi.
    out.push_back({FanKind::corner, 2, 0.5});
    out.push_back({FanKind::corner, 4, 0.7 * M_PI});
    out.push_back({FanKind::corner, 5, 1.6 * M_PI});
    return out;
}

//! Affine weight of each local column: 1 for points, 0 for vectors.
MaskRow point_columns(const Case& c)
{
    MaskRow out;
    for (VertexColumn column : peters_vertex_columns(c.kind, c.sectors)) {
        out.push_back(column == VertexColumn::control || column == VertexColumn::position);
    }
    out.resize(out.size() + 2 * c.edges(), 1.0);
    return out;
}

double apply(const MaskRow& row, const MaskRow& x)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < row.size(); ++i)
        sum += row[i] * x[i];
    return sum;
}

void add(MaskRow& row, double w, const MaskRow& other)
{
    for (std::size_t i = 0; i < row.size(); ++i)
        row[i] += w * other[i];
}

double largest(const MaskRow& row)
{
    double m = 0.0;
    for (double w : row)
        m = std::max(m, std::fabs(w));
    return m;
}

//! q1 and q2 of every edge, by the rules of the quadratic spline.
struct EdgePoints {
    std::vector<MaskRow> q1, q2;
};
EdgePoints edge_points(const Case& c, const PetersMask& m)
{
    EdgePoints out;
    const MaskRow zero(m.apex.size(), 0.0);
    for (Index i = 0; i < c.edges(); ++i) {
        MaskRow q1 = zero, q2 = zero;
        if (!c.closed() && (i == 0 || i == c.sectors)) {
            // The tangents are columns 1 and 2 of a corner; a smooth vertex has -t, a dart t again.
            q1 = m.apex;
            if (i == 0)
                q1[1] += 1.0;
            else if (c.kind == FanKind::corner)
                q1[2] += 1.0;
            else
                q1[1] += c.kind == FanKind::smooth ? -1.0 : 1.0;
            add(q2, 0.5, q1);
            q2[m.edge_column(i, 0)] += 0.5;
        } else {
            const MaskRow &a = m.leg[i], &b = m.leg[(i + c.sectors - 1) % c.sectors];
            add(q1, 0.5, a);
            add(q1, 0.5, b);
            add(q2, 0.5, q1);
            q2[m.edge_column(i, 0)] += 0.25;
            q2[m.edge_column(i, 1)] += 0.25;
        }
        out.q1.push_back(q1);
        out.q2.push_back(q2);
    }
    return out;
}

TEST(PetersMasks, rows_sum_to_one_and_twists_to_zero_for_every_fan)
{
    for (const Case& c : peters_cases()) {
        const PetersMask m = peters_mask(c.kind, c.sectors, c.alpha);
        const MaskRow points = point_columns(c);
        ASSERT_EQ(m.apex.size(), points.size()) << c.name();
        EXPECT_NEAR(apply(m.apex, points), 1.0, 1e-15) << c.name();
        for (const MaskRow& leg : m.leg)
            EXPECT_NEAR(apply(leg, points), 1.0, 1e-15) << c.name();
        for (const MaskRow& t : m.twist)
            EXPECT_NEAR(apply(t, points), 0.0, 1e-15) << c.name();
    }
}

TEST(PetersMasks, edge_tangents_are_a_first_harmonic)
{
    // q1_(i+1) + q1_(i-1) - 2 q0 = 2 c (q1_i - q0): row 0 of the smoothness condition.
    for (const Case& c : peters_cases()) {
        if (c.sectors < 2)
            continue;
        const PetersMask m = peters_mask(c.kind, c.sectors, c.alpha);
        const EdgePoints e = edge_points(c, m);
        const Index n = c.sectors;
        for (Index i = c.closed() ? 0 : 1; i < n; ++i) {
            const double cosine = c.cosine();
            MaskRow rest = e.q1[c.closed() ? (i + 1) % n : i + 1];
            add(rest, 1.0, e.q1[c.closed() ? (i + n - 1) % n : i - 1]);
            add(rest, -2.0 + 2.0 * cosine, m.apex);
            add(rest, -2.0 * cosine, e.q1[i]);
            EXPECT_LE(largest(rest), 1e-14) << c.name() << " edge " << i;
        }
    }
}

TEST(PetersMasks, twists_solve_the_mixed_derivative_condition)
{
    // delta_i + delta_(i-1) = (4 c / 9) (q2_i - 2 q1_i + q0); around an even valence above four
    // only up to the alternating sum of q2, which the constraint removes.
    for (const Case& c : peters_cases()) {
        const PetersMask m = peters_mask(c.kind, c.sectors, c.alpha);
        const double cosine = c.cosine();
        const Index n = c.sectors;
        if (m.twist.empty()) {
            EXPECT_TRUE(n == 1 || std::fabs(cosine) < 1e-12) << c.name();
            continue;
        }
        EXPECT_GT(std::fabs(cosine), 0.1) << c.name();
        const EdgePoints e = edge_points(c, m);
        MaskRow alternating(m.apex.size(), 0.0);
        for (Index i = 0; i < c.edges(); ++i)
            add(alternating, i % 2 == 0 ? 1.0 : -1.0, e.q2[i]);
        const bool constrained = c.closed() && n % 2 == 0;
        for (Index i = c.closed() ? 0 : 1; i < n; ++i) {
            MaskRow rest = m.twist[i];
            add(rest, 1.0, m.twist[(i + n - 1) % n]);
            const double s = 4.0 * cosine / 9.0;
            add(rest, -s, e.q2[i]);
            add(rest, 2.0 * s, e.q1[i]);
            add(rest, -s, m.apex);
            if (constrained) {
                EXPECT_GT(largest(rest), 1e-3) << c.name();
                add(rest, (i % 2 == 0 ? 1.0 : -1.0) * s / n, alternating);
            }
            EXPECT_LE(largest(rest), 2e-15) << c.name() << " edge " << i;
        }
    }
}

TEST(PetersMasks, the_constraint_is_the_alternating_sum_of_the_second_controls)
{
    for (Index n = 6; n <= 12; n += 2) {
        const Case c{FanKind::closed, n, 2.0 * M_PI};
        const PetersMask m = peters_mask(c.kind, n, c.alpha);
        const EdgePoints e = edge_points(c, m);
        MaskRow alternating(m.apex.size(), 0.0);
        for (Index i = 0; i < n; ++i)
            add(alternating, i % 2 == 0 ? 4.0 : -4.0, e.q2[i]);
        for (Index i = 0; i < n; ++i) {
            alternating[m.edge_column(i, 0)] -= i % 2 == 0 ? 1.0 : -1.0;
            alternating[m.edge_column(i, 1)] -= i % 2 == 0 ? 1.0 : -1.0;
        }
        EXPECT_LE(largest(alternating), 1e-14) << n;
    }
}

TEST(PetersMasks, even_closed_fans_have_the_smallest_twists)
{
    // Nothing left of the kernel (-1)^i of the condition.
    for (Index n = 6; n <= 12; n += 2) {
        const PetersMask m = peters_mask(FanKind::closed, n, 2.0 * M_PI);
        MaskRow kernel(m.apex.size(), 0.0);
        for (Index i = 0; i < n; ++i)
            add(kernel, i % 2 == 0 ? 1.0 : -1.0, m.twist[i]);
        EXPECT_LE(largest(kernel), 2e-15) << n;
    }
}

TEST(PetersMasks, turning_a_closed_fan_by_a_sector_turns_its_twists)
{
    // Of the second controls, which are numbered by edge, so the row of sector i + 1 is that of i
    // moved by one edge.
    for (Index n = 3; n <= 12; ++n) {
        const PetersMask m = peters_mask(FanKind::closed, n, 2.0 * M_PI);
        if (m.twist.empty())
            continue;
        for (Index i = 0; i < n; ++i) {
            for (Index e = 0; e < n; ++e) {
                for (Index second : {0u, 1u}) {
                    EXPECT_NEAR(m.twist[(i + 1) % n][m.edge_column((e + 1) % n, second)],
                                m.twist[i][m.edge_column(e, second)], 1e-16);
                }
            }
        }
    }
}

TEST(PetersMasks, valence_3_has_its_exact_rational_twist)
{
    // delta_i = (r_i + r_(i+1) - r_(i+2)) / 2 with c = -1/2: r = -(2/9)(q2 - 2 q1 + q0), worked out
    // by hand for the column of A_0 (in r_0 and r_1: -(2/9)(1/4 - 1 + 1/3) = 5/54, in r_2: -4/54).
    const PetersMask m = peters_mask(FanKind::closed, 3, 2.0 * M_PI);
    EXPECT_NEAR(m.twist[0][0], 7.0 / 54.0, 1e-15);
    EXPECT_NEAR(m.twist[1][0], -2.0 / 54.0, 1e-15);
    EXPECT_NEAR(m.twist[2][0], -2.0 / 54.0, 1e-15);
    EXPECT_NEAR(m.twist[0][m.edge_column(0, 0)], -1.0 / 36.0, 1e-16);
    EXPECT_NEAR(m.twist[0][m.edge_column(1, 1)], -1.0 / 36.0, 1e-16);
    EXPECT_NEAR(m.twist[0][m.edge_column(2, 0)], 1.0 / 36.0, 1e-16);
}

TEST(PetersMasks, valence_6_and_8_have_their_exact_weights)
{
    // Of r_(i-l), times the share c / 9 a second control has in r.
    const std::vector<double> six{5, -3, 1, 1, -3, 5}, eight{7, -5, 3, -1, -1, 3, -5, 7};
    for (const auto& [n, w, over] : {std::tuple{6u, six, 12.0}, std::tuple{8u, eight, 16.0}}) {
        const PetersMask m = peters_mask(FanKind::closed, n, 2.0 * M_PI);
        const double share = std::cos(2.0 * M_PI / n) / 9.0;
        for (Index l = 0; l < n; ++l) {
            EXPECT_NEAR(m.twist[0][m.edge_column((n - l) % n, 0)], share * w[l] / over, 1e-16) << n;
        }
    }
}

TEST(EckHoppeMasks, rows_sum_to_one_for_valence_3_to_12)
{
    for (Index n = 3; n <= 12; ++n) {
        const EckHoppeMask m = eck_hoppe_mask(n);
        const MaskRow ones(4 * n, 1.0);
        EXPECT_NEAR(apply(m.apex, ones), 1.0, 1e-15);
        for (const auto* rows : {&m.edge1, &m.edge2, &m.b11, &m.b21, &m.b12, &m.b22}) {
            ASSERT_EQ(rows->size(), n);
            for (const MaskRow& row : *rows)
                EXPECT_NEAR(apply(row, ones), 1.0, 1e-14) << n;
        }
    }
}

TEST(EckHoppeMasks, rows_satisfy_the_linear_cross_derivative_law)
{
    // b(J,1) + b'(1,J) - 2 x_J for the factor 2 c (1 - t), as rows of
    // Bezier coefficients. Row 1 of an even valence holds up to the alternating sum of the second
    // controls.
    for (Index n = 3; n <= 12; ++n) {
        if (n == 4)
            continue;
        const EckHoppeMask m = eck_hoppe_mask(n);
        const double c = std::cos(2.0 * M_PI / n), a = c / (1.0 - c);
        for (Index i = 0; i < n; ++i) {
            const Index before = (i + n - 1) % n, after = (i + 1) % n;
            MaskRow q2(4 * n, 0.0); // coefficient (3, 0)
            for (Index column : {4 * i, 4 * before, 4 * i + 1, 4 * i + 2})
                q2[column] = 0.25;

            MaskRow row0 = m.edge1[after];
            add(row0, 1.0, m.edge1[before]);
            add(row0, -2.0 + 2.0 * c, m.apex);
            add(row0, -2.0 * c, m.edge1[i]);
            EXPECT_LE(largest(row0), 1e-14) << n;

            MaskRow row1 = m.b11[i];
            add(row1, 1.0, m.b11[before]);
            add(row1, -2.0 + 4.0 * c / 3.0, m.edge1[i]);
            add(row1, -4.0 * c / 3.0, m.edge2[i]);
            if (n % 2 == 0) {
                const double share = 2.0 / n * (2.0 * c / 3.0) * (1.0 - 2.0 * a) / 12.0;
                for (Index k = 0; k < n; ++k) {
                    const double sign = (k + i) % 2 == 0 ? 1.0 : -1.0;
                    row1[4 * k + 1] += sign * share;
                    row1[4 * k + 2] += sign * share;
                }
            }
            EXPECT_LE(largest(row1), 1e-14) << n;

            MaskRow row2 = m.b21[i];
            add(row2, 1.0, m.b12[before]);
            add(row2, -2.0 + 2.0 * c / 3.0, m.edge2[i]);
            add(row2, -2.0 * c / 3.0, q2);
            EXPECT_LE(largest(row2), 1e-15) << n;
        }
    }
}

} // namespace
} // namespace bot2nurbs
