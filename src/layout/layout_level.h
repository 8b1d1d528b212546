// SPDX-License-Identifier: MIT
#pragma once

#include "layout/curves.h"
#include "layout/tiles.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace bot2nurbs {

//! A mesh that a layout is made on: cut open along all curves, so that everything left to do
//! happens between boundaries. Where a curve was cut, each of its vertices has several copies here,
//! with one name.
class LayoutLevel {
public:
    //! `name` gives each vertex of the mesh its name, 0 .. name_count - 1; curves are in names.
    LayoutLevel(const ManifoldMesh& mesh, std::vector<Index> name, Index name_count,
                std::vector<double> density, std::vector<Curve> curves);

    const ManifoldMesh& mesh() const { return *mesh_; }
    Index name(Index vertex) const { return name_[vertex]; }
    const std::vector<double>& density() const { return density_; } //!< As SizeField::density.
    const std::vector<Curve>& curves() const { return curves_; }

    //! Names that must be sites, beside those on curves.
    std::vector<Index> required;
    //! Pairs of names whose tiles must not be neighbours.
    std::vector<std::array<Index, 2>> apart;
    //! Of a mesh that stands for a finer one: the angle of that at each boundary vertex. The chords
    //! of a coarse mesh make corners where a curve runs smoothly on.
    std::vector<std::pair<Index, double>> boundary_angles;

    //! Makes patches small where curves are short: no wider than the distance between the ends of a
    //! curve, and growing with the distance from it no faster than a given slope. `unit` is the
    //! width of patches where the density is one. Cost O(n log n).
    void refine_at_curves(double unit);

    //! Calls act(vertex) for every vertex of a name.
    template <class Act> void for_each_copy(Index name, const Act& act) const
    {
        for (Index i = offset_[name]; i < offset_[name + 1]; ++i)
            act(copies_[i]);
    }
    //! One of the vertices of a name; all are at the same place.
    Index any_copy(Index name) const { return copies_[offset_[name]]; }
    //! The vertices of the names of `vertices`, each once, ascending.
    std::vector<Index> with_copies(const std::vector<Index>& vertices) const;
    //! Whether the vertices of a name lie on a curve or the boundary.
    bool on_curve(Index name) const { return mesh_->is_boundary_vertex(any_copy(name)); }
    std::vector<Vec3> points(const Curve& curve) const;
    std::vector<double> densities(const Curve& curve) const; //!< The largest of the copies.
    //! Number of the connected component of each vertex.
    const std::vector<Index>& regions() const { return region_; }
    Index region_count() const { return region_count_; }

private:
    const ManifoldMesh* mesh_;
    std::vector<Index> name_;
    std::vector<double> density_;
    std::vector<Curve> curves_;
    std::vector<Index> offset_, copies_; // By name.
    std::vector<Index> region_;
    Index region_count_ = 0;
};

} // namespace bot2nurbs
