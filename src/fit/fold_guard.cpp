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

//! The places of one quad.
class QuadPlaces {
public:
    //! `source`: null where nothing is known of it.
    QuadPlaces(const SplineSurface& surface, Index quad, const SourceNormals* source)
        : surface_(surface), quad_(quad)
    {
        find_normals();
        find_sides_of_folds();
        for (Index k = 0; k < places_per_quad && source != nullptr; ++k) {
            const Place& p = place_[k];
            if (source->far(quad, p.u, p.v, p.normal))
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
                            const std::optional<SourceNormals>& source, const Context& context,
                            const Measure& measure)
{
    std::vector<Value> values(surface.patch_count());
    for_each_chunk(context, values.size(), chunk_quads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t q = begin; q < end; ++q)
            values[q] =
                measure(QuadPlaces(surface, static_cast<Index>(q), source ? &*source : nullptr));
    });
    return values;
}

} // namespace

void FoldGuard::set_source(const std::vector<Vec3>& normals, const std::vector<DomainPoint>& where)
{
    source_.emplace(complex_, normals, where);
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
