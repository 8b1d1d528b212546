// SPDX-License-Identifier: MIT
#include "convert/cloud_json.h"

namespace bot2nurbs {

namespace {

using Json = nlohmann::ordered_json;

//! Holes listed, the largest first.
constexpr std::size_t most_holes = 100;

Json place_json(const Vec3& p)
{
    return Json::array({p.x, p.y, p.z});
}

const char* name_of(NormalMode mode)
{
    switch (mode) {
    case NormalMode::automatic: return "auto";
    case NormalMode::given: return "given";
    case NormalMode::estimate: return "estimate";
    }
    return "";
}

Json normals_json(const NormalReport& n)
{
    return {{"source", n.given ? "given" : "estimated"},
            {"file_has_normals", n.file_has_normals},
            {"filled_in", n.filled_in},
            {"given_contradicted", n.given_contradicted},
            {"given_flipped", n.given_flipped},
            {"solved_points", n.solved_points},
            {"disagreement", n.disagreement}};
}

Json holes_json(const std::vector<CloudHole>& holes)
{
    Json list = Json::array();
    for (const CloudHole& h : holes)
        if (list.size() < most_holes)
            list.push_back({{"place", place_json(h.place)},
                            {"size", h.size},
                            {"spacings", h.spacings},
                            {"area", h.area},
                            {"filled", h.filled}});
    return list;
}

Json deviation_json(const CloudReport& r)
{
    const PointDeviation& d = r.deviation;
    Json within = Json::array();
    for (const ShareWithin& w : r.within)
        within.push_back(
            {{"distance", w.distance}, {"distance_relative", w.relative}, {"share", w.share}});
    return {{"points", d.points},
            {"max", d.max},
            {"rms", d.rms},
            {"median", d.median},
            {"percentile_95", d.percentile_95},
            {"far_points", d.far_points},
            {"within", within},
            {"surface_to_points",
             {{"samples", r.surface_to_points.samples},
              {"covered", r.surface_to_points.covered},
              {"reach", r.surface_to_points.reach},
              {"max", r.surface_to_points.max},
              {"rms", r.surface_to_points.rms}}}};
}

} // namespace

Json cloud_json(const CloudReport& r, bool fitted)
{
    Json j;
    j["points"] = r.points;
    j["not_finite"] = r.not_finite;
    j["duplicates"] = r.duplicates;
    j["outliers"] = r.outliers;
    j["off_mesh"] = r.off_mesh;
    j["fitted"] = r.fitted;
    j["normals"] = normals_json(r.normals);
    j["spacing"] = r.spacing;
    j["noise"] = r.noise;
    j["noise_ratio"] = r.noise_ratio;
    j["topology"] = name(r.topology);
    j["doubts"] = r.evidence.doubts;
    j["depth"] = r.evidence.depth;
    j["genus"] = r.evidence.genus;
    j["finer_genus"] = r.evidence.finer_genus;
    j["components"] = r.evidence.components;
    j["dropped_components"] = r.evidence.dropped_components;
    j["unused_points"] = r.evidence.unused_points;
    j["uncovered_area"] = r.evidence.uncovered_area;
    j["hole_count"] = r.evidence.holes.size();
    j["holes"] = holes_json(r.evidence.holes);
    if (fitted) {
        j["anchors"] = r.anchors;
        j["deviation"] = deviation_json(r);
    }
    return j;
}

Json cloud_options_json(const CloudOptions& o)
{
    Json j;
    j["points"] = o.points;
    j["normals"] = name_of(o.normals);
    j["viewpoint"] = o.orient.viewpoint ? place_json(*o.orient.viewpoint) : Json(nullptr);
    j["reconstruction"] = name(o.reconstruct.method);
    j["depth"] = o.reconstruct.depth ? Json(*o.reconstruct.depth) : Json(nullptr);
    j["fill_holes"] = o.reconstruct.fill_holes ? Json(*o.reconstruct.fill_holes) : Json(nullptr);
    return j;
}

} // namespace bot2nurbs
