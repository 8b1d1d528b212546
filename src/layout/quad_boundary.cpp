// SPDX-License-Identifier: MIT
#include "layout/quad_boundary.h"

namespace bot2nurbs {

std::vector<std::vector<Index>> boundary_loops(const QuadComplex& complex)
{
    std::vector<std::vector<Index>> loops;
    std::vector<char> seen(complex.halfedge_count(), 0);
    for (Index first = 0; first < complex.halfedge_count(); ++first) {
        if (complex.twin(first) != invalid_index || seen[first])
            continue;
        loops.emplace_back();
        for (Index h = first; !seen[h];) {
            seen[h] = 1;
            loops.back().push_back(h);
            h = QuadComplex::next(h);
            while (complex.twin(h) != invalid_index)
                h = QuadComplex::next(complex.twin(h));
        }
    }
    return loops;
}

} // namespace bot2nurbs
