// SPDX-License-Identifier: MIT
#include "fit/fold_guard.h"

#include "core/parallel.h"
#include "spline/bernstein.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace bot2nurbs {

namespace {

//! Places on a piece and direction, as parameters of the piece: near the corners, where folds at
//! extraordinary vertices begin, and between.
constexpr std::array<double, 5> places{0.02, 0.26, 0.5, 0.74, 0.98};
//! Places of a quad: side x side, those of constant u in a row.
constexpr Index side = places.size() * pieces_per_side;
constexpr Index places_per_quad = side * side;
//! Normals of the source are known by cells, 3 x 3 of a piece: so many samples there are.
constexpr Index cells_per_piece_side = 3;
constexpr Index cell_side = cells_per_piece_side * pieces_per_side;
constexpr Index cells_per_quad = cell_side * cell_side;
//! No cone of normals is taken to be narrower than this, the sine of its half angle: samples are
//! few.
constexpr double least_slack = 0.3;
//! Places whose normals are opposed even when the way between them was halved so often are on
//! either side of a fold.
constexpr int halvings = 12;
constexpr std::size_t chunk_quads = 16;

double parameter(Index i)
{
    return (i / places.size() + places[i % places.size()]) / pieces_per_side;
}

//! Bernstein polynomials, and their derivatives, at the places on a piece.
struct PlaceBasis {
    std::array<Cubic, places.size()> value, slope;

    PlaceBasis()
    {
        for (std::size_t k = 0; k < places.size(); ++k) {
            value[k] = bernstein(places[k]);
            slope[k] = bernstein_d(places[k]);
        }
    }
};

Index cell_at(double u, double v)
{
    const auto along = [](double x) {
        return std::min(cell_side - 1, static_cast<Index>(std::max(0.0, cell_side * x)));
    };
    return cell_side * along(u) + along(v);
}

struct NormalSum {
    Vec3 sum;
    double count = 0.0;

    void add(const NormalSum& other)
    {
        sum += other.sum;
        count += other.count;
    }
};

//! Minus the cosine of the angle from which a normal is far from these: a right angle beyond their
//! cone, as the surface may well stand across them where it rounds an edge or a groove. Those of a
//! cone of half angle a have a mean of length (1 + cos a) / 2.
double slack_of(const NormalSum& normals)
{
    const double cosine = std::max(0.0, 2.0 * norm(normals.sum) / normals.count - 1.0);
    return std::max(least_slack, std::sqrt(std::max(0.0, 1.0 - cosine * cosine)));
}

//! The places of one quad.
class QuadPlaces {
public:
    //! `source`: what is known of it, by cells, or null.
    QuadPlaces(const SplineSurface& surface, Index quad, const FoldGuard::Source* source)
        : surface_(surface), quad_(quad)
    {
        find_normals();
        find_sides_of_folds();
        for (Index k = 0; k < places_per_quad && source != nullptr; ++k) {
            const Place& p = place_[k];
            const FoldGuard::Source& there = source[cell_at(p.u, p.v)];
            const double along = dot(p.normal, there.normal);
            if (along < 0.0 && along < -there.slack * norm(p.normal))
                sign_[k] = -1;
        }
    }

    Index fold_count() const
    {
        return static_cast<Index>(std::count(sign_.begin(), sign_.end(), -1));
    }
    double smallest_jacobian() const
    {
        double sum = 0.0, least = INFINITY;
        for (Index k = 0; k < places_per_quad; ++k) {
            const double jacobian = norm(place_[k].normal);
            sum += jacobian / places_per_quad;
            least = std::min(least, sign_[k] * jacobian);
        }
        return sum > 0.0 ? least / sum : 0.0;
    }

private:
    struct Place {
        double u = 0.0, v = 0.0;
        Vec3 normal; //!< du x dv
    };

    Place at(double u, double v) const
    {
        const SurfacePoint s = surface_.evaluate({quad_, u, v});
        return {u, v, cross(s.du, s.dv)};
    }
    void find_normals()
    {
        static const PlaceBasis basis;
        constexpr Index per_piece = places.size();
        for (Index i = 0; i < side; ++i) {
            const Cubic &value = basis.value[i % per_piece], &slope = basis.slope[i % per_piece];
            // Coefficients of the line of constant u, and of the derivative across it.
            std::array<Vec3, SplineNetwork::grid> line{}, across{};
            for (Index a = 0; a < 4; ++a)
                for (Index j = 0; j < SplineNetwork::grid; ++j) {
                    const Vec3& c = surface_.bezier(quad_, 3 * (i / per_piece) + a, j);
                    line[j] += value[a] * c;
                    across[j] += slope[a] * c;
                }
            for (Index j = 0; j < side; ++j) {
                const Index first = 3 * (j / per_piece);
                Vec3 du, dv;
                for (Index a = 0; a < 4; ++a) {
                    du += basis.value[j % per_piece][a] * across[first + a];
                    dv += basis.slope[j % per_piece][a] * line[first + a];
                }
                place_[side * i + j] = {parameter(i), parameter(j),
                                        double(pieces_per_side * pieces_per_side) * cross(du, dv)};
            }
        }
    }
    static bool opposed(const Place& a, const Place& b) { return dot(a.normal, b.normal) < 0.0; }
    bool fold_between(const Place& from, const Place& to) const
    {
        if (!opposed(from, to))
            return false;
        Place a = from, b = to;
        for (int i = 0; i < halvings && opposed(a, b); ++i) {
            const Place middle = at(0.5 * (a.u + b.u), 0.5 * (a.v + b.v));
            // Opposed to neither: the surface has turned on the way, and the loop ends.
            (opposed(a, middle) ? b : a) = middle;
        }
        return opposed(a, b);
    }
    void find_sides_of_folds()
    {
        // From place to place: down the first column, and along every row.
        sign_[0] = 1;
        for (Index k = 1; k < places_per_quad; ++k) {
            const Index before = k % side > 0 ? k - 1 : k - side;
            sign_[k] = fold_between(place_[before], place_[k]) ? -sign_[before] : sign_[before];
        }
        if (2 * fold_count() > places_per_quad)
            for (int& s : sign_)
                s = -s;
        // A fold that ends inside changes the sign one way round its end and not the other.
        for (Index k = side; k < places_per_quad; ++k)
            if (sign_[k] == sign_[k - side] && fold_between(place_[k - side], place_[k]))
                sign_[k] = -1;
    }

    const SplineSurface& surface_;
    Index quad_;
    std::array<Place, places_per_quad> place_;
    std::array<int, places_per_quad> sign_{};
};

template <class Value, class Measure>
std::vector<Value> of_quads(const SplineSurface& surface,
                            const std::vector<FoldGuard::Source>& source, const Context& context,
                            const Measure& measure)
{
    std::vector<Value> values(surface.patch_count());
    for_each_chunk(context, values.size(), chunk_quads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t q = begin; q < end; ++q)
            values[q] = measure(QuadPlaces(surface, static_cast<Index>(q),
                                           source.empty() ? nullptr : &source[cells_per_quad * q]));
    });
    return values;
}

} // namespace

void FoldGuard::set_source(const std::vector<Vec3>& normals, const std::vector<DomainPoint>& where)
{
    const std::size_t count = static_cast<std::size_t>(cells_per_quad) * quads_;
    const auto piece_of = [](std::size_t cell) {
        const std::size_t k = cell % cells_per_quad;
        return pieces_per_side * pieces_per_side * (cell / cells_per_quad) +
               pieces_per_side * (k / cell_side / cells_per_piece_side) +
               k % cell_side / cells_per_piece_side;
    };
    std::vector<NormalSum> in_cell(count),
        on_piece(count / (cells_per_piece_side * cells_per_piece_side));
    for (std::size_t i = 0; i < normals.size(); ++i)
        in_cell[cells_per_quad * where[i].quad + cell_at(where[i].u, where[i].v)].add(
            {normals[i], 1.0});
    for (std::size_t c = 0; c < count; ++c)
        on_piece[piece_of(c)].add(in_cell[c]);
    source_.assign(count, {});
    for (std::size_t c = 0; c < count; ++c) {
        const NormalSum& around = on_piece[piece_of(c)];
        const NormalSum& here = in_cell[c].count > 0.0 ? in_cell[c] : around;
        if (around.count > 0.0)
            source_[c] = {normalized(here.sum), slack_of(around)};
    }
}

std::vector<Index> FoldGuard::folds(const SplineSurface& surface, const Context& context) const
{
    return of_quads<Index>(surface, source_, context,
                           [](const QuadPlaces& q) { return q.fold_count(); });
}

std::vector<double> FoldGuard::smallest_jacobians(const SplineSurface& surface,
                                                  const Context& context) const
{
    return of_quads<double>(surface, source_, context,
                            [](const QuadPlaces& q) { return q.smallest_jacobian(); });
}

} // namespace bot2nurbs
