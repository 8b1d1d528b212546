// SPDX-License-Identifier: MIT
#include "layout/uncut.h"

#include <map>
#include <tuple>

namespace bot2nurbs {

PatchComplex uncut(const PatchComplex& complex, const CutMesh& cut, const ManifoldMesh& whole,
                   const std::vector<char>& marks)
{
    PatchComplex result(whole);
    std::vector<PatchComplex::Side> side(complex.paths().size()); // Where each path went, forward.
    // Paths along a cut, by their ends and first step.
    std::map<std::tuple<Index, Index, Index>, Index> along;
    const auto second = [](const SurfacePath& p) {
        return p.nodes.empty() ? p.b : p.nodes[0].vertex;
    };
    const auto last = [](const SurfacePath& p) {
        return p.nodes.empty() ? p.a : p.nodes.back().vertex;
    };
    for (Index p = 0; p < complex.paths().size(); ++p) {
        if (!complex.paths()[p].alive)
            continue;
        SurfacePath path = complex.paths()[p].geometry;
        path.a = cut.original(path.a);
        path.b = cut.original(path.b);
        for (PathNode& n : path.nodes)
            if (n.is_vertex())
                n.vertex = cut.original(n.vertex);
        if (complex.is_boundary(p)) {
            const auto other = along.find({path.b, path.a, last(path)});
            const auto same = along.find({path.a, path.b, second(path)});
            if (other != along.end() || same != along.end()) {
                side[p] = other != along.end() ? PatchComplex::Side{other->second, true}
                                               : PatchComplex::Side{same->second, false};
                continue;
            }
            along[{path.a, path.b, second(path)}] = static_cast<Index>(result.paths().size());
        }
        const Index first = complex.is_boundary(p) ? second(path) : invalid_index;
        const Index a = path.a;
        side[p] = {result.add_path(std::move(path)), false};
        if (first != invalid_index) {
            const Index h = whole.find_halfedge(a, first);
            result.mark(side[p].path,
                        marks[h != invalid_index ? h : whole.find_halfedge(first, a)]);
        }
    }
    for (const PatchComplex::Face& face : complex.faces()) {
        if (!face.alive())
            continue;
        std::vector<PatchComplex::Side> sides;
        for (const PatchComplex::Side& s : face.sides)
            sides.push_back(s.reversed ? PatchComplex::opposite(side[s.path]) : side[s.path]);
        result.add_face(std::move(sides));
    }
    return result;
}

} // namespace bot2nurbs
