// SPDX-License-Identifier: MIT
#include "fit/source_normals.h"

#include "spline/bernstein.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

//! 3 x 3 cells of a piece: so many samples there are.
constexpr Index cells_per_piece_side = 3;
constexpr Index cell_side = cells_per_piece_side * pieces_per_side;
//! With a frame of cells of the quads around.
constexpr Index frame_side = cell_side + 2;
constexpr Index cells_per_quad = frame_side * frame_side;
constexpr Index pieces_per_quad = pieces_per_side * pieces_per_side;
//! No cone of normals is taken to be narrower than this, the sine of its half angle: samples are
//! few.
constexpr double least_slack = 0.3;

Index along(double x)
{
    return std::min(cell_side - 1, static_cast<Index>(std::max(0.0, cell_side * x)));
}

//! Column i and row j, from 1 inside the frame.
std::size_t cell(Index quad, Index i, Index j)
{
    return static_cast<std::size_t>(cells_per_quad) * quad + frame_side * i + j;
}

//! The cell in the frame beside side s of a quad, as the k-th from where the side starts.
std::size_t frame_cell(Index halfedge, Index k)
{
    const Index quad = QuadComplex::quad_of(halfedge);
    constexpr Index last = frame_side - 1;
    switch (halfedge % 4) {
    case 0: return cell(quad, k + 1, 0);
    case 1: return cell(quad, last, k + 1);
    case 2: return cell(quad, last - 1 - k, last);
    default: return cell(quad, 0, last - 1 - k);
    }
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

//! Fills the frame of every quad from its neighbours over smooth edges.
void fill_frames(const QuadComplex& complex, std::vector<NormalSum>& sums)
{
    for (Index h = 0; h < 4 * complex.quad_count(); ++h) {
        if (complex.is_sharp(complex.edge(h)))
            continue;
        const Index twin = complex.twin(h);
        constexpr Index last = frame_side - 1;
        for (Index k = 0; k < cell_side; ++k) {
            const Index from = cell_side - 1 - k; // Along the twin, which runs the other way.
            const Index quad = QuadComplex::quad_of(twin);
            std::size_t inside = 0;
            switch (twin % 4) {
            case 0: inside = cell(quad, from + 1, 1); break;
            case 1: inside = cell(quad, last - 1, from + 1); break;
            case 2: inside = cell(quad, last - 1 - from, last - 1); break;
            default: inside = cell(quad, 1, last - 1 - from);
            }
            sums[frame_cell(h, k)] = sums[inside];
        }
    }
}

} // namespace

SourceNormals::SourceNormals(const QuadComplex& complex, const std::vector<Vec3>& normals,
                             const std::vector<DomainPoint>& where)
{
    std::vector<NormalSum> sums(static_cast<std::size_t>(cells_per_quad) * complex.quad_count());
    std::vector<NormalSum> on_piece(static_cast<std::size_t>(pieces_per_quad) *
                                    complex.quad_count());
    const auto piece = [](Index quad, Index i, Index j) {
        return static_cast<std::size_t>(pieces_per_quad) * quad +
               pieces_per_side * (i / cells_per_piece_side) + j / cells_per_piece_side;
    };
    for (std::size_t s = 0; s < normals.size(); ++s) {
        const Index i = along(where[s].u), j = along(where[s].v);
        sums[cell(where[s].quad, i + 1, j + 1)].add({normals[s], 1.0});
        on_piece[piece(where[s].quad, i, j)].add({normals[s], 1.0});
    }
    fill_frames(complex, sums);
    cells_.resize(sums.size());
    for (Index q = 0; q < complex.quad_count(); ++q)
        for (Index i = 0; i < frame_side; ++i)
            for (Index j = 0; j < frame_side; ++j) {
                const NormalSum& here = sums[cell(q, i, j)];
                const bool filled = here.count > 0.0;
                const bool inside = i > 0 && j > 0 && i <= cell_side && j <= cell_side;
                const NormalSum& around = inside ? on_piece[piece(q, i - 1, j - 1)] : here;
                if (around.count > 0.0)
                    cells_[cell(q, i, j)] = {normalized(filled ? here.sum : around.sum),
                                             slack_of(around), filled};
            }
}

bool SourceNormals::far(Index quad, double u, double v, const Vec3& normal) const
{
    const auto far_from = [&](const Cell& c) {
        const double cosine = dot(normal, c.normal);
        return cosine < 0.0 && cosine < -c.slack * norm(normal);
    };
    const Index i = along(u) + 1, j = along(v) + 1;
    if (!far_from(cells_[cell(quad, i, j)]))
        return false;
    for (Index a = i - 1; a <= i + 1; ++a)
        for (Index b = j - 1; b <= j + 1; ++b) {
            const Cell& c = cells_[cell(quad, a, b)];
            if (c.filled && !far_from(c))
                return false;
        }
    return true;
}

} // namespace bot2nurbs
