// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/convert.h"
#include "bot2nurbs/domain_file.h"
#include "hand_domains.h"

#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <string>
#include <unistd.h>
#include <vector>

namespace bot2nurbs::test {

inline std::string read_file(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline void write_file(const std::filesystem::path& path, const std::string& text)
{
    std::ofstream(path, std::ios::binary) << text;
}

//! OFF text of meshes in one file, every coordinate to the bit.
inline std::string off_text(const std::vector<ManifoldMesh>& meshes)
{
    std::size_t vertices = 0, faces = 0;
    for (const ManifoldMesh& m : meshes) {
        vertices += m.vertex_count();
        faces += m.face_count();
    }
    std::string text = fmt::format("OFF\n{} {} 0\n", vertices, faces);
    for (const ManifoldMesh& m : meshes)
        for (const Vec3& p : m.positions())
            text += fmt::format("{:.17g} {:.17g} {:.17g}\n", p.x, p.y, p.z);
    std::size_t first = 0;
    for (const ManifoldMesh& m : meshes) {
        for (const auto& t : m.triangles())
            text += fmt::format("3 {} {} {}\n", first + t[0], first + t[1], first + t[2]);
        first += m.vertex_count();
    }
    return text;
}

//! The mesh with every position p moved to scale p + offset, and the domain carried along.
inline HandDomain moved(const HandDomain& hand, double scale, const Vec3& offset)
{
    std::vector<Vec3> positions = hand.mesh.positions();
    for (Vec3& p : positions)
        p = scale * p + offset;
    HandDomain result = hand;
    result.mesh = *ManifoldMesh::build(std::move(positions), hand.mesh.triangles());
    result.domain.carrier = CarrierMesh::from_source(result.mesh);
    result.domain.source_signature = signature(result.mesh);
    result.charts.clear();
    return result;
}

//! A folder of its own for each test, removed at its end.
class ConvertTest : public ::testing::Test {
protected:
    void SetUp() override
    {
        std::string name = std::filesystem::temp_directory_path() / "bot2nurbs-XXXXXX";
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return folder_ / name; }

    //! Writes mesh.off and domain.json of hand-made domains.
    ConvertOptions options_for(const std::vector<HandDomain>& hands) const
    {
        std::vector<ManifoldMesh> meshes;
        std::vector<QuadDomain> domains;
        for (const HandDomain& hand : hands) {
            meshes.push_back(hand.mesh);
            domains.push_back(hand.domain);
        }
        write_file(path("mesh.off"), off_text(meshes));
        write_file(path("domain.json"), domains_to_json(domains));
        ConvertOptions options;
        options.input = path("mesh.off");
        options.domain_in = path("domain.json");
        return options;
    }

    std::vector<std::string> files() const
    {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder_))
            names.push_back(entry.path().filename());
        std::sort(names.begin(), names.end());
        return names;
    }

private:
    std::filesystem::path folder_;
};

} // namespace bot2nurbs::test
