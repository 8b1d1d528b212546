// SPDX-License-Identifier: MIT
//! Masks and corner patches against numbers computed elsewhere.

#include "network_fixtures.h"
#include "spline/vertex_masks.h"

#include <fstream>
#include <nlohmann/json.hpp>

namespace bot2nurbs {
namespace {

using namespace fixtures;
using Json = nlohmann::json;

//! Legs A_i and twists when local column j has the value (3 j + 1) mod 7 - 3, in 40-digit
//! arithmetic: the twists are the pseudo-inverse solution of the mixed derivative conditions (for
//! an open fan, nearest to the mean of r), by a singular value decomposition and no formula of
//! ours.
struct Known {
    FanKind kind;
    Index sectors;
    double alpha;
    std::vector<double> legs, twists;
};

const std::vector<Known>& known_masks()
{
    static const std::vector<Known> table{
        {FanKind::closed,
         3,
         2.0 * M_PI,
         {-2.0, 1.0, -3.0},
         {-0.32407407407407407, 0.39814814814814814, -0.37962962962962965}},
        {FanKind::closed,
         5,
         2.0 * M_PI,
         {-3.1796275840160826, -5.908677525004944, -3.23606797749979, 1.1447455025047337,
          1.1796275840160826},
         {0.1901787666925763, 0.5056215917109612, 0.12732200375003505, -0.28959137948883246,
          -0.15584354509535991}},
        {FanKind::closed,
         6,
         2.0 * M_PI,
         {-2.732050807568877, -5.464101615137754, -4.732050807568878, -1.2679491924311228,
          1.4641016151377546, 0.7320508075688773},
         {0.3396010605207388, 0.5727206395599961, 0.5803418012614795, 0.13262116170148341,
          -0.5449428617822184, -0.33034180126147955}},
        {FanKind::closed,
         7,
         2.0 * M_PI,
         {-2.444723856422586, -4.999285434668126, -5.295323906335445, -3.109916264174742,
          -0.08871903692474714, 1.49324464210306, 0.44472385642258594},
         {0.30025686366050114, 0.7618945830949458, 0.7541435944581151, 0.23067382387669863,
          0.018438471584436088, -0.8645540925515806, -0.23098021900953078}},
        {FanKind::closed,
         8,
         2.0 * M_PI,
         {-2.242640687119285, -4.585786437626905, -5.414213562373095, -4.242640687119285,
          -1.7573593128807148, 0.585786437626905, 1.4142135623730951, 0.24264068711928516},
         {0.28307229129697264, 0.6389384907981696, 0.9913354769374817, 0.8330442322198429,
          0.09012295432926076, -0.5800129256992905, -0.6967076514430869, -0.2241467261980937}},
        {FanKind::smooth,
         3,
         M_PI,
         {-2.732050807568877, -5.464101615137754, -4.732050807568878},
         {0.29793439385407217, 0.623646565485922, 0.5201566160762944}},
        {FanKind::smooth,
         4,
         M_PI,
         {-2.242640687119285, -4.585786437626905, -5.414213562373095, -4.242640687119285},
         {0.40121252260822093, 0.5797238245858002, 0.9916245780509721, 0.8916806962052315}},
        {FanKind::dart,
         5,
         2.0 * M_PI,
         {-3.1796275840160826, -5.908677525004944, -3.23606797749979, 1.1447455025047337,
          1.1796275840160826},
         {0.28002437374114947, 0.38144076306517166, 0.2171676107986082, -0.1734256569541073,
          -0.30634448922730145}},
        {FanKind::corner,
         2,
         2.0 * M_PI / 3.0,
         {-2.6666666666666665, -5.333333333333333},
         {0.3055555555555556, 0.5833333333333334}},
        {FanKind::corner,
         4,
         1.5 * M_PI,
         {1.0045359137578969, 1.3041081460400032, -2.475681021293813, -5.668178637919299},
         {-0.17407477196407747, -0.4605815566646921, 0.18482491931502515, 0.6414132295112352}},
    };
    return table;
}

TEST(Oracle, masks_equal_a_pseudo_inverse_in_high_precision)
{
    for (const Known& known : known_masks()) {
        const PetersMask m = peters_mask(known.kind, known.sectors, known.alpha);
        const auto value = [](const MaskRow& row) {
            double sum = 0.0;
            for (std::size_t j = 0; j < row.size(); ++j) {
                sum += row[j] * (static_cast<double>((3 * j + 1) % 7) - 3.0);
            }
            return sum;
        };
        for (Index i = 0; i < known.sectors; ++i) {
            EXPECT_NEAR(value(m.leg[i]), known.legs[i], 4e-15) << known.sectors;
            EXPECT_NEAR(value(m.twist[i]), known.twists[i], 4e-15) << known.sectors;
        }
    }
}

//! The test vectors beside a checkout of the design; a lone clone does without.
Json shared_vectors(const std::string& file)
{
    const std::string path = std::string(BOT2NURBS_SHARED) + "/oracle/" + file;
    std::ifstream in(path);
    return in ? Json::parse(in) : Json();
}

Vec3 vec(const Json& j)
{
    return {j[0], j[1], j[2]};
}

//! Column of largest weight in a row: identifies the unknown a coefficient next to it belongs to.
Index main_column(const SplineNetwork& network, Index h, Index along, Index depth)
{
    const auto [a, b] = from_side(QuadComplex::side_of(h), along, depth, 12);
    const SparseRows& s = network.stencils;
    const Index row = SplineNetwork::row(QuadComplex::quad_of(h), a, b);
    std::size_t best = s.offset[row];
    for (std::size_t i = best; i < s.offset[row + 1]; ++i) {
        if (std::fabs(s.weight[i]) > std::fabs(s.weight[best]))
            best = i;
    }
    return s.column[best];
}

void expect_near(const Vec3& value, const Json& expected, double bound, const std::string& what)
{
    EXPECT_LE(max_abs(value - vec(expected)), bound) << what;
}

//! Corner patches of all sectors against b[i][J][K].
void expect_corner_patches(const SplineSurface& s, const std::vector<Index>& sectors, const Json& b,
                           const std::string& name)
{
    for (std::size_t i = 0; i < sectors.size(); ++i) {
        for (Index j = 0; j < 4; ++j) {
            for (Index k = 0; k < 4; ++k) {
                const std::string what = name + " sector " + std::to_string(i) + " (" +
                                         std::to_string(j) + ", " + std::to_string(k) + ")";
                expect_near(local_bezier(s, sectors[i], j, k), b[i][j][k], 1e-14, what);
            }
        }
    }
}

//! Sets B+, B- and C of all sectors. An open fan has one more B- than sectors.
void set_outer_controls(const SplineNetwork& network, const std::vector<Index>& sectors,
                        const Json& v, const std::string& suffix, std::vector<Vec3>& x)
{
    const Json &bplus = v["Bplus" + suffix], &bminus = v["Bminus" + suffix];
    for (std::size_t i = 0; i < sectors.size(); ++i) {
        x[main_column(network, sectors[i], 4, 1)] = vec(bplus[i]);
        x[main_column(network, sectors[i], 1, 4)] = vec(bminus[(i + 1) % bminus.size()]);
        x[main_column(network, sectors[i], 4, 4)] = vec(v["C"][i]);
    }
}

TEST(Oracle, closed_fans_equal_the_shared_vectors)
{
    const Json all = shared_vectors("vectors.json");
    if (all.is_null())
        GTEST_SKIP() << "no vectors.json beside this checkout";
    int seen = 0;
    for (const Json& v : all["vectors"]) {
        if (v["type"] != "closed")
            continue;
        ++seen;
        const Index n = v["n"];
        const Domain d = star(n);
        const SplineNetwork network = network_of(d);
        const std::vector<Index> sectors = sectors_at(d.complex, 0);
        std::vector<Vec3> x(network.unknown_count);
        set_outer_controls(network, sectors, v, "_projected", x);
        if (n <= 4) {
            for (Index i = 0; i < n; ++i) {
                x[main_column(network, sectors[i], 1, 1)] = vec(v["A"][i]);
            }
        } else {
            // The projection of raw controls to the unknowns of the vertex.
            const Index q0 = main_column(network, sectors[0], 0, 0);
            const double phi = 2.0 * M_PI / n, scale = 2.0 / n * std::cos(phi / 2);
            for (Index i = 0; i < n; ++i) {
                const Vec3 a = vec(v["A"][i]);
                x[q0] += a / n;
                x[q0 + 1] += scale * std::cos((i + 0.5) * phi) * a;
                x[q0 + 2] += scale * std::sin((i + 0.5) * phi) * a;
                if (n % 2 == 0)
                    x[q0 + 3] += (i % 2 == 0 ? 1.0 : -1.0) / n * a;
            }
        }
        for (Index r = 0; r < network.constraints.row_count(); ++r) {
            EXPECT_LE(max_abs(row_value(network.constraints, r, x)), 1e-14);
        }
        const std::string name = "closed " + std::to_string(n);
        const SplineSurface s(network, x);
        expect_near(local_bezier(s, sectors[0], 0, 0), v["q0"], 1e-15, name);
        expect_corner_patches(s, sectors, v["b"], name);
        for (Index i = 0; i < n; ++i) {
            expect_near(local_bezier(s, sectors[i], 3, 0), v["q2"][i], 1e-14, name + " q2");
        }
    }
    EXPECT_EQ(seen, 6);
}

//! Mask rows of an open fan applied to the inputs of a vector: legs and twists.
void expect_open_mask(const Json& v, FanKind kind)
{
    const Index k = v["k"];
    const std::string name = v["type"].get<std::string>() + " " + std::to_string(k);
    const PetersMask m = peters_mask(kind, k, v["alpha"]);
    std::vector<Vec3> x(m.vertex_columns + 2 * (k + 1));
    x[0] = vec(v["q0"]);
    x[1] = vec(v["u"]);
    x[2] = kind == FanKind::corner ? vec(v["t_k"]) : vec(v["v"]);
    x[3] = vec(v["a"]);
    x[m.edge_column(0, 0)] = vec(v["E_first_next"]);
    x[m.edge_column(k, 0)] = vec(v["E_last_next"]);
    for (Index i = 1; i < k; ++i) {
        x[m.edge_column(i, 0)] = vec(v["Bplus"][i]);
        x[m.edge_column(i, 1)] = vec(v["Bminus"][i]);
    }
    const auto value = [&x](const MaskRow& row) {
        Vec3 sum;
        for (std::size_t j = 0; j < row.size(); ++j)
            sum += row[j] * x[j];
        return sum;
    };
    for (Index i = 0; i < k; ++i) {
        expect_near(value(m.leg[i]), v["A"][i], 2e-14, name + " leg");
        if (m.twist.empty()) {
            EXPECT_LE(max_abs(vec(v["delta"][i])), 1e-15) << name;
        } else {
            expect_near(value(m.twist[i]), v["delta"][i], 2e-14, name + " twist");
        }
    }
}

TEST(Oracle, masks_of_open_fans_equal_the_shared_vectors)
{
    const Json all = shared_vectors("vectors.json");
    if (all.is_null())
        GTEST_SKIP() << "no vectors.json beside this checkout";
    int seen = 0;
    for (const Json& v : all["vectors"]) {
        if (v["type"] == "closed")
            continue;
        ++seen;
        expect_open_mask(v, v["type"] == "smooth" ? FanKind::smooth
                            : v["type"] == "dart" ? FanKind::dart
                                                  : FanKind::corner);
    }
    EXPECT_EQ(seen, 10);
}

TEST(Oracle, patches_of_open_fans_equal_the_shared_vectors)
{
    const Json all = shared_vectors("vectors.json");
    if (all.is_null())
        GTEST_SKIP() << "no vectors.json beside this checkout";
    int seen = 0;
    for (const Json& v : all["vectors"]) {
        const std::string type = v["type"];
        if (type == "closed")
            continue;
        const Index k = v["k"];
        const bool corner = type == "corner";
        // Only fans of the default angle occur in a network.
        if (corner && std::fabs(v["alpha"].get<double>() - corner_fan_angle(k)) > 1e-12)
            continue;
        ++seen;
        Domain d = type == "dart" ? star(k) : star_sectors(8, 1, k);
        if (type == "dart")
            d = with_features(d, "dart", {{0, neighbours(d.complex, 0)[0]}});
        if (corner)
            d = with_features(d, "corner", {}, {0});
        const SplineNetwork network = network_of(d);
        const std::vector<Index> sectors = sectors_at(d.complex, 0);
        std::vector<Vec3> x(network.unknown_count);
        set_outer_controls(network, sectors, v, "", x);
        x[main_column(network, sectors.front(), 4, 0)] = vec(v["E_first_next"]);
        x[main_column(network, sectors.back(), 0, 4)] = vec(v["E_last_next"]);
        const Index q0 = main_column(network, sectors[0], 0, 0);
        x[q0] = vec(v["q0"]);
        x[q0 + 1] = vec(v["u"]);
        x[q0 + 2] = corner ? vec(v["t_k"]) : vec(v["v"]);
        x[q0 + 3] = vec(v["a"]);
        expect_corner_patches(SplineSurface(network, x), sectors, v["b"],
                              type + " " + std::to_string(k));
    }
    EXPECT_EQ(seen, 9);
}

TEST(Oracle, the_masks_of_1996_equal_the_shared_vectors)
{
    const Json all = shared_vectors("vectors_paper.json");
    if (all.is_null())
        GTEST_SKIP() << "no vectors_paper.json beside this checkout";
    int seen = 0;
    for (const Json& v : all["vectors"]) {
        ++seen;
        const Index n = v["n"];
        const Domain d = n == 3 ? cube() : split_bipyramid(n);
        const Index vertex = n == 3 ? 0 : n;
        ASSERT_EQ(d.complex.valence(vertex), n);
        const SplineNetwork network = network_of(d, SplineScheme::eck_hoppe);
        const std::vector<Index> sectors = sectors_at(d.complex, vertex);
        std::vector<Vec3> x(network.unknown_count);
        // All controls are unknowns, numbered like the controls: 16 a quad.
        const auto control = [&](Index h, Index along, Index depth) -> Vec3& {
            const auto [a, b] = from_side(QuadComplex::side_of(h), along, depth, 3);
            return x[16 * QuadComplex::quad_of(h) + 4 * a + b];
        };
        for (Index i = 0; i < n; ++i) {
            control(sectors[i], 0, 0) = vec(v["A"][i]);
            control(sectors[i], 1, 0) = vec(v["Bplus_projected"][i]);
            control(sectors[(i + n - 1) % n], 0, 1) = vec(v["Bminus_projected"][i]);
            control(sectors[i], 1, 1) = vec(v["C"][i]);
        }
        const std::string name = "1996 masks " + std::to_string(n);
        expect_corner_patches(SplineSurface(network, x), sectors, v["b"], name);
    }
    EXPECT_EQ(seen, 5);
}

} // namespace
} // namespace bot2nurbs
