// SPDX-License-Identifier: MIT
// Writes the points of a cloud with the normals that bot2nurbs estimates for them, one point a line
// "x y z nx ny nz": for orientation.py.
//
//     orient_points CLOUD OUTPUT.xyz

#include "bot2nurbs/find_normals.h"
#include "bot2nurbs/read_points.h"

#include <cstdio>
#include <fstream>
#include <iomanip>

namespace {

int fail(const bot2nurbs::Error& error)
{
    std::fprintf(stderr, "%s\n", error.message.c_str());
    return 1;
}

} // namespace

int main(int argc, char** argv)
{
    using namespace bot2nurbs;
    if (argc != 3) {
        std::fprintf(stderr, "usage: orient_points CLOUD OUTPUT.xyz\n");
        return 2;
    }
    Context context;
    const Result<PointCloud> cloud = read_points(argv[1], context);
    if (!cloud)
        return fail(cloud.error());
    const Result<CleanPoints> points = clean_points(*cloud, context);
    if (!points)
        return fail(points.error());
    const Result<CloudNormals> normals = find_normals(*points, NormalMode::estimate, {}, context);
    if (!normals)
        return fail(normals.error());
    std::ofstream out(argv[2]);
    out << std::setprecision(17);
    for (std::size_t i = 0; i < points->positions.size(); ++i) {
        const Vec3& p = points->positions[i];
        const Vec3& n = normals->estimate.normals[i];
        out << p.x << ' ' << p.y << ' ' << p.z << ' ' << n.x << ' ' << n.y << ' ' << n.z << '\n';
    }
    return out.flush() ? 0 : 1;
}
