// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/manifold_mesh.h"
#include "bot2nurbs/tolerance.h"

#include <optional>
#include <string>
#include <vector>

namespace bot2nurbs {

struct RepairOptions {
    double weld = tolerance::weld;  //!< Weld distance as a fraction of the box diagonal; 0 welds
                                    //!< equal positions only. In [0, 0.1].
    bool split_nonmanifold = false; //!< Cut the surface apart along edges with more than two faces
                                    //!< and at vertices where several fans meet.

    std::optional<Error> check() const;
};

//! One change that was made, or (a warning) one defect that was left.
struct RepairNote {
    std::string code;    //!< Stable name: see repair_mesh.
    std::string message; //!< In words, with counts.
    Index count = 0;
    bool warning = false;
};

//! One connected piece of the input as a manifold mesh.
struct MeshComponent {
    ManifoldMesh mesh;
    std::vector<Index> source_vertex; //!< Per vertex: the (first) vertex of the soup.
    std::vector<Index> source_face;   //!< Per face: the triangle of the soup.
    int genus = 0;
    Index boundary_loops = 0;
    double volume = 0.0; //!< Signed; 0 when open.
    //! The component whose inside directly surrounds this closed one, or invalid_index.
    Index surrounded_by = invalid_index;
    //! Surrounded by an odd number of components and turned inward: the wall of a hollow.
    bool cavity = false;
};

struct RepairedMesh {
    std::vector<MeshComponent> components; //!< In the order of their first faces.
    std::vector<RepairNote> notes;
    Box3 box;
};

//! Makes manifold meshes of a soup by harmless changes only, and says what it changed:
//! 1. weld: vertices of open edges that agree within the weld distance become one. Vertices inside
//!    a closed fan of faces are left alone, so that solids that merely touch stay apart, and fans
//!    that the weld would only join in a point keep vertices of their own;
//! 2. repeated_vertex, duplicate_face: such faces go (of copies the first stays);
//! 3. collapsed_edge, flipped_cap: faces without area (thinner than tolerance::weld, however far
//!    corners are welded) go; an edge of no length is collapsed, a
//!    corner on its opposite edge splits that edge's other face. What cannot go without tearing or
//!    folding the surface stays, with the warning zero_area_kept;
//! 4. oriented: faces are turned to agree with the majority of their component;
//! 5. turned_outward: a closed component with negative volume is turned, unless an odd number of
//!    other components surrounds it: then it is a cavity and stays. The warning nested_solid says
//!    that a surrounded component turns outward: it is kept as a solid of its own;
//! 6. unused_vertex: vertices without faces go;
//! 7. with split_nonmanifold: split_edge, split_vertex.
//!
//! Further warning: no_volume (a closed component that is flat or folded back on itself).
//! Open components are no error. Errors: empty_input; bad_geometry (invalid index, not finite, or
//! all points at one place); not_manifold, not_orientable, naming the first element in the
//! numbering of the soup; bad_option; cancelled. Cost O(F log F).
Result<RepairedMesh> repair_mesh(TriangleSoup soup, const RepairOptions& options, Context& context);

} // namespace bot2nurbs
