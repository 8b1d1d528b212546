// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/repair_mesh.h"
#include "convert/text_file.h"

#include <utility>

namespace bot2nurbs {

//! Reads a JSON file with something for each component of a mesh. `parse(text, meshes)` returns a
//! Result of it; errors get the file's name in front. Errors: cannot_read, those of `parse`.
template <class Parse>
auto read_for_components(const std::string& path, const RepairedMesh& mesh, const Parse& parse)
    -> decltype(parse(std::string(), std::vector<ManifoldMesh>()))
{
    const Result<std::string> text = read_text(path);
    if (!text)
        return text.error();
    std::vector<ManifoldMesh> meshes;
    for (const MeshComponent& c : mesh.components)
        meshes.push_back(c.mesh);
    auto parsed = parse(*text, meshes);
    if (!parsed)
        return in_file(path, parsed.error());
    return parsed;
}

} // namespace bot2nurbs
