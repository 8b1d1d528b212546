// SPDX-License-Identifier: MIT
#include "layout/patch_complex.h"

#include <algorithm>
#include <cassert>

namespace bot2nurbs {

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
    faces_.push_back({std::move(sides)});
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
    std::vector<Side> around;
    Side current = s;
    do {
        around.push_back(current);
        const Side before = previous(current);
        current = {before.path, !before.reversed};
    } while (!(current == s));
    return around;
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

std::optional<Overlay> PatchComplex::overlay(Index face)
{
    return builder_.disk(geometry(faces_[face].sides));
}

std::optional<Overlay> PatchComplex::overlay(const std::vector<Side>& border,
                                             OverlayBuilder& builder) const
{
    return builder.disk(geometry(border));
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
            if (!inside(face_at({s.path, !s.reversed})))
                outer.push_back(s);
    if (outer.size() < 3)
        return std::nullopt;
    // Chain them: from the end of a side turn through the inside to the next outer side.
    std::vector<Side> chain;
    Side s = outer.front();
    do {
        chain.push_back(s);
        Side n = next(s);
        while (inside(face_at({n.path, !n.reversed})))
            n = next({n.path, !n.reversed});
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

std::optional<MappedDisk> PatchComplex::mapped(const std::vector<Side>& border)
{
    return map_disk(builder_, geometry(border));
}

bool PatchComplex::replace(const std::vector<Index>& old_faces, const std::vector<Side>& border,
                           const std::vector<std::pair<Index, Index>>& chords)
{
    if (chords.empty()) {
        exchange(old_faces, border, chords, {});
        return true;
    }
    const std::optional<MappedDisk> disk = mapped(border);
    return disk && replace(old_faces, border, chords, *disk);
}

bool PatchComplex::replace(const std::vector<Index>& old_faces, const std::vector<Side>& border,
                           const std::vector<std::pair<Index, Index>>& chords,
                           const MappedDisk& disk, Index center)
{
    auto drawn = retile(mesh(), disk, chords, center);
    if (!drawn)
        return false;
    exchange(old_faces, border, chords, std::move(*drawn));
    return true;
}

void PatchComplex::exchange(const std::vector<Index>& old_faces, const std::vector<Side>& border,
                            const std::vector<std::pair<Index, Index>>& chords,
                            std::vector<SurfacePath> drawn)
{
    const auto inside = [&old_faces](Index f) {
        return std::find(old_faces.begin(), old_faces.end(), f) != old_faces.end();
    };
    last_.removed_faces.clear();
    last_.removed_paths.clear();
    last_.first_new_face = static_cast<Index>(faces_.size());
    last_.first_new_path = static_cast<Index>(paths_.size());
    for (const Index f : old_faces)
        for (const Side& s : faces_[f].sides)
            if (!s.reversed && inside(paths_[s.path].left) && inside(paths_[s.path].right)) {
                paths_[s.path].alive = false;
                last_.removed_paths.push_back(s.path);
            }
    for (const Index f : old_faces) {
        last_.removed_faces.emplace_back(f, std::move(faces_[f].sides));
        faces_[f].sides.clear();
        --alive_faces_;
    }

    // Each new face is traced once: from a border side, turning left at each corner.
    const Index n = static_cast<Index>(border.size());
    struct End {
        Side side;    // Leaves the corner.
        Index target; // Corner, or invalid for the centre.
    };
    std::vector<std::vector<End>> leaving(n + 1); // Index n: the centre.
    const auto slot = [n](Index corner) { return corner == invalid_index ? n : corner; };
    for (std::size_t i = 0; i < chords.size(); ++i) {
        const Index p = add_path(std::move(drawn[i]));
        leaving[slot(chords[i].first)].push_back({{p, false}, chords[i].second});
        leaving[slot(chords[i].second)].push_back({{p, true}, chords[i].first});
    }
    std::vector<char> used(n, 0);
    for (Index first = 0; first < n; ++first) {
        if (used[first])
            continue;
        std::vector<Side> sides;
        Index from = first, at = (first + 1) % n;
        sides.push_back(border[first]);
        used[first] = 1;
        while (at != first) {
            // Leftmost way on from `at`, having come from `from` (a corner, or the centre).
            if (at == invalid_index) {
                // At the centre: the spoke to the next corner clockwise from where we came.
                const End* best = nullptr;
                Index best_offset = 0;
                for (const End& e : leaving[n]) {
                    const Index offset = (from + n - e.target) % n;
                    if (offset != 0 && (!best || offset < best_offset))
                        best = &e, best_offset = offset;
                }
                assert(best);
                sides.push_back(best->side);
                from = invalid_index;
                at = best->target;
                continue;
            }
            const End* best = nullptr;
            Index best_offset = 0;
            for (const End& e : leaving[at]) {
                if (e.target == from)
                    continue;
                // The centre is reached whenever there is a spoke: spokes exclude chords here.
                const Index offset = e.target == invalid_index ? n : (e.target + n - at) % n;
                const Index limit = from == invalid_index ? n : (from + n - at) % n;
                if (from == invalid_index && e.target == invalid_index)
                    continue;
                if (e.target != invalid_index && offset > limit)
                    continue;
                if (!best || offset > best_offset)
                    best = &e, best_offset = offset;
            }
            if (best) {
                sides.push_back(best->side);
                from = at;
                at = best->target;
            } else {
                sides.push_back(border[at]);
                used[at] = 1;
                from = at;
                at = (at + 1) % n;
            }
        }
        add_face(std::move(sides));
    }
}

void PatchComplex::undo()
{
    alive_faces_ -= new_face_count();
    faces_.resize(last_.first_new_face);
    paths_.resize(last_.first_new_path);
    for (const Index p : last_.removed_paths)
        paths_[p].alive = true;
    for (auto& [f, sides] : last_.removed_faces) {
        for (const Side& s : sides)
            (s.reversed ? paths_[s.path].right : paths_[s.path].left) = f;
        faces_[f].sides = std::move(sides);
        ++alive_faces_;
    }
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
    for (Path& p : paths) {
        p.left = face_number[p.left];
        p.right = face_number[p.right];
    }
    paths_ = std::move(paths);
    faces_ = std::move(faces);
}

} // namespace bot2nurbs
