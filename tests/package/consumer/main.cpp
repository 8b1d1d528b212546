// SPDX-License-Identifier: MIT
// What a program that uses bot2nurbs does: builds a mesh, looks at it, asks for a conversion.
#include <bot2nurbs/convert.h>
#include <bot2nurbs/version.h>

#include <cstdio>

int main()
{
    using namespace bot2nurbs;
    const Result<ManifoldMesh> tetrahedron = ManifoldMesh::build(
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
    ConvertOptions options;
    options.input = "no-such-mesh.off";
    options.outputs = {"no-such-mesh.step"};
    Context context;
    const Result<ConvertReport> report = convert(options, context);
    const bool right = tetrahedron && tetrahedron->closed() && tetrahedron->volume() > 0.0 &&
                       !report && report.error().code == ErrorCode::cannot_read;
    std::printf("bot2nurbs %s %s\n", BOT2NURBS_VERSION, right ? "works" : "does not work");
    return right ? 0 : 1;
}
