// SPDX-License-Identifier: MIT
#include "layout/patch_complex.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace bot2nurbs {

double boundary_angle(const ManifoldMesh& mesh, Index vertex)
{
    double sum = 0.0;
    for (Index h = mesh.halfedge_at(vertex); h != invalid_index;
         h = mesh.twin(ManifoldMesh::prev(h))) {
        const Vec3 p = mesh.position(mesh.to(h)) - mesh.position(vertex);
        const Vec3 q = mesh.position(mesh.from(ManifoldMesh::prev(h))) - mesh.position(vertex);
        sum += std::atan2(norm(cross(p, q)), dot(p, q));
    }
    return sum;
}

double PatchComplex::boundary_angle(Index mesh_vertex) const
{
    const auto said = angle_.find(mesh_vertex);
    return said != angle_.end() ? said->second : bot2nurbs::boundary_angle(*mesh_, mesh_vertex);
}

Index PatchComplex::add_path(SurfacePath geometry)
{
    Path path;
    path.geometry = std::move(geometry);
    path.alive = true;
    paths_.push_back(std::move(path));
    return static_cast<Index>(paths_.size() - 1);
}

Index PatchComplex::add_face(std::vector<Side> sides)
{
    const Index f = static_cast<Index>(faces_.size());
    for (const Side& s : sides)
        (s.reversed ? paths_[s.path].right : paths_[s.path].left) = f;
    faces_.push_back({std::move(sides), false});
    ++alive_faces_;
    return f;
}

Index PatchComplex::position(const Side& s) const
{
    const auto& sides = faces_[face_at(s)].sides;
    const auto found = std::find(sides.begin(), sides.end(), s);
    assert(found != sides.end());
    return static_cast<Index>(found - sides.begin());
}

PatchComplex::Side PatchComplex::next(const Side& s) const
{
    const auto& sides = faces_[face_at(s)].sides;
    return sides[(position(s) + 1) % sides.size()];
}

PatchComplex::Side PatchComplex::previous(const Side& s) const
{
    const auto& sides = faces_[face_at(s)].sides;
    return sides[(position(s) + sides.size() - 1) % sides.size()];
}

std::vector<PatchComplex::Side> PatchComplex::star(const Side& s) const
{
    // At the boundary begin where no face lies to the right.
    Side first = s;
    while (face_at(opposite(first)) != invalid_index) {
        first = next(opposite(first));
        if (first == s)
            break;
    }
    std::vector<Side> around;
    Side current = first;
    do {
        around.push_back(current);
        if (face_at(current) == invalid_index)
            break;
        current = opposite(previous(current));
    } while (!(current == first));
    return around;
}

std::vector<Index> PatchComplex::faces_around(const Side& s) const
{
    std::vector<Index> faces;
    for (const Side& spoke : star(s))
        if (face_at(spoke) != invalid_index)
            faces.push_back(face_at(spoke));
    return faces;
}

bool PatchComplex::is_fixed_vertex(const Side& s) const
{
    if (pinned_.count(start(s)) != 0)
        return true;
    const std::vector<Side> around = star(s);
    return std::any_of(around.begin(), around.end(),
                       [this](const Side& spoke) { return is_fixed(spoke.path); });
}

std::optional<Index> PatchComplex::path_between(Index a, Index b) const
{
    for (Index p = 0; p < paths_.size(); ++p)
        if (paths_[p].alive &&
            std::minmax(paths_[p].geometry.a, paths_[p].geometry.b) == std::minmax(a, b))
            return p;
    return std::nullopt;
}

std::vector<Index> PatchComplex::corners(Index face) const
{
    std::vector<Index> result;
    for (const Side& s : faces_[face].sides)
        result.push_back(start(s));
    return result;
}

std::vector<PathSide> PatchComplex::geometry(const std::vector<Side>& sides) const
{
    std::vector<PathSide> result;
    result.reserve(sides.size());
    for (const Side& s : sides)
        result.push_back({&paths_[s.path].geometry, s.reversed});
    return result;
}

std::vector<PatchComplex::Side> PatchComplex::vertex_sides() const
{
    std::vector<Side> at(mesh().vertex_count());
    for (Index p = 0; p < paths_.size(); ++p)
        if (paths_[p].alive) {
            const SurfacePath& g = paths_[p].geometry;
            if (at[g.a].path == invalid_index)
                at[g.a] = {p, false};
            if (at[g.b].path == invalid_index)
                at[g.b] = {p, true};
        }
    std::vector<Side> result;
    for (const Side& s : at)
        if (s.path != invalid_index)
            result.push_back(s);
    return result;
}

std::optional<std::vector<PatchComplex::Side>>
PatchComplex::border(const std::vector<Index>& faces) const
{
    const auto inside = [&faces](Index f) {
        return std::find(faces.begin(), faces.end(), f) != faces.end();
    };
    std::vector<Side> outer;
    for (const Index f : faces)
        for (const Side& s : faces_[f].sides)
            if (!inside(face_at(opposite(s))))
                outer.push_back(s);
    if (outer.size() < 3)
        return std::nullopt;
    // Chain them: from the end of a side turn through the inside to the next outer side.
    std::vector<Side> chain;
    Side s = outer.front();
    do {
        chain.push_back(s);
        Side n = next(s);
        while (inside(face_at(opposite(n))))
            n = next(opposite(n));
        s = n;
    } while (!(s == outer.front()) && chain.size() <= outer.size());
    if (chain.size() != outer.size())
        return std::nullopt;
    std::vector<Index> ends;
    for (const Side& c : chain)
        ends.push_back(start(c));
    std::sort(ends.begin(), ends.end());
    if (std::adjacent_find(ends.begin(), ends.end()) != ends.end())
        return std::nullopt;
    return chain;
}

std::optional<PatchComplex::Change> PatchComplex::plan(std::vector<Index> faces,
                                                       std::vector<Side> border,
                                                       std::vector<Chord> chords,
                                                       const MappedDisk& disk, Index center) const
{
    auto drawn = retile(mesh(), disk, chords, center);
    if (!drawn)
        return std::nullopt;
    return Change{std::move(faces), std::move(border), std::move(chords), std::move(*drawn)};
}

std::optional<PatchComplex::Change> PatchComplex::plan(std::vector<Index> faces,
                                                       std::vector<Side> border,
                                                       std::vector<Chord> chords,
                                                       OverlayBuilder& builder) const
{
    if (chords.empty())
        return Change{std::move(faces), std::move(border), {}, {}};
    const std::optional<MappedDisk> disk = map_disk(builder, geometry(border));
    if (!disk)
        return std::nullopt;
    return plan(std::move(faces), std::move(border), std::move(chords), *disk);
}

std::vector<std::vector<PathSide>> PatchComplex::faces_after(const Change& change) const
{
    std::vector<std::vector<PathSide>> result;
    for (const auto& piece : trace_faces(static_cast<Index>(change.border.size()), change.chords)) {
        std::vector<PathSide> sides;
        for (const TracedSide& t : piece) {
            const Side s = t.is_chord ? Side{} : change.border[t.number];
            sides.push_back(t.is_chord ? PathSide{&change.drawn[t.number], t.reversed}
                                       : PathSide{&paths_[s.path].geometry, s.reversed});
        }
        result.push_back(std::move(sides));
    }
    return result;
}

Index PatchComplex::apply(Change change)
{
    const auto inside = [&change](Index f) {
        return std::find(change.faces.begin(), change.faces.end(), f) != change.faces.end();
    };
    for (const Index f : change.faces)
        for (const Side& s : faces_[f].sides)
            if (!s.reversed && inside(paths_[s.path].left) && inside(paths_[s.path].right)) {
                paths_[s.path].alive = false;
                paths_[s.path].geometry = {};
            }
    for (const Index f : change.faces) {
        faces_[f].sides.clear();
        --alive_faces_;
    }
    const Index first_path = static_cast<Index>(paths_.size());
    for (SurfacePath& path : change.drawn)
        add_path(std::move(path));
    const Index first_face = static_cast<Index>(faces_.size());
    for (const auto& piece : trace_faces(static_cast<Index>(change.border.size()), change.chords)) {
        std::vector<Side> sides;
        for (const TracedSide& t : piece)
            sides.push_back(t.is_chord ? Side{first_path + t.number, t.reversed}
                                       : change.border[t.number]);
        add_face(std::move(sides));
    }
    return first_face;
}

void PatchComplex::compact()
{
    std::vector<Index> path_number(paths_.size(), invalid_index);
    std::vector<Index> face_number(faces_.size(), invalid_index);
    std::vector<Path> paths;
    std::vector<Face> faces;
    for (Index p = 0; p < paths_.size(); ++p)
        if (paths_[p].alive) {
            path_number[p] = static_cast<Index>(paths.size());
            paths.push_back(std::move(paths_[p]));
        }
    for (Index f = 0; f < faces_.size(); ++f)
        if (faces_[f].alive()) {
            face_number[f] = static_cast<Index>(faces.size());
            faces.push_back(std::move(faces_[f]));
        }
    for (Face& f : faces)
        for (Side& s : f.sides)
            s.path = path_number[s.path];
    for (Path& p : paths)
        for (Index* f : {&p.left, &p.right})
            if (*f != invalid_index)
                *f = face_number[*f];
    paths_ = std::move(paths);
    faces_ = std::move(faces);
}

} // namespace bot2nurbs
