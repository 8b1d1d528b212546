// SPDX-License-Identifier: MIT
#include "layout/straighten_paths.h"

#include "core/parallel.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <utility>

namespace bot2nurbs {

namespace {

using Side = PatchComplex::Side;

// The path drawn anew in the disk of its two faces.
std::optional<PatchComplex::Change> straightened(const PatchComplex& complex, Index path,
                                                 OverlayBuilder& builder)
{
    const PatchComplex::Path& p = complex.paths()[path];
    const std::vector<Index> faces{p.left, p.right};
    const auto border = complex.border(faces);
    if (!border)
        return std::nullopt;
    const auto corner = [&](Index vertex) {
        Index i = 0;
        while (i < border->size() && complex.start((*border)[i]) != vertex)
            ++i;
        return i;
    };
    const Index a = corner(p.geometry.a), b = corner(p.geometry.b);
    if (a == border->size() || b == border->size())
        return std::nullopt;
    return complex.plan(faces, *border, {{a, b}}, builder);
}

} // namespace

Status straighten_paths(PatchComplex& complex, int passes, Context& context)
{
    oneapi::tbb::enumerable_thread_specific<OverlayBuilder> builders(
        [&complex] { return OverlayBuilder(complex.mesh()); });
    for (int pass = 0; pass < passes; ++pass) {
        std::vector<Index> waiting;
        for (Index p = 0; p < complex.paths().size(); ++p)
            if (!complex.is_fixed(p))
                waiting.push_back(p);
        while (!waiting.empty()) {
            // As many as share no face, side by side.
            std::vector<char> used(complex.faces().size(), 0);
            std::vector<Index> now, later;
            for (const Index p : waiting) {
                const PatchComplex::Path& path = complex.paths()[p];
                if (path.left == path.right)
                    continue;
                const bool free = !used[path.left] && !used[path.right];
                (free ? now : later).push_back(p);
                used[path.left] = used[path.right] = 1;
            }
            std::vector<std::optional<PatchComplex::Change>> changes(now.size());
            const bool finished =
                for_each_chunk(context, now.size(), 8, [&](std::size_t begin, std::size_t end) {
                    for (std::size_t i = begin; i < end; ++i)
                        changes[i] = straightened(complex, now[i], builders.local());
                });
            if (!finished)
                return Context::cancelled_error("layout");
            for (auto& change : changes)
                if (change)
                    complex.apply(std::move(*change));
            waiting = std::move(later);
        }
        complex.compact();
    }
    return {};
}

} // namespace bot2nurbs
