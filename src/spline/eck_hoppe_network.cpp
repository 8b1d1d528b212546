// SPDX-License-Identifier: MIT
#include "spline/control_net.h"
#include "spline/schemes.h"

#include <map>
#include <string>

namespace bot2nurbs {

namespace {

class EckHoppeAssembly : ControlNet {
public:
    explicit EckHoppeAssembly(const QuadComplex& complex) : ControlNet(complex) {}
    void build(const std::vector<Fan>& fans, SplineNetwork& network);

private:
    void apply_mask(const Fan& fan, const EckHoppeMask& mask);
};

void EckHoppeAssembly::apply_mask(const Fan& fan, const EckHoppeMask& mask)
{
    const Index n = fan.sector_count();
    std::vector<Signed> columns(4 * std::size_t(n));
    for (Index i = 0; i < n; ++i) {
        const Index h = fan.sectors[i];
        columns[4 * i].unknown = control_unknown(h, 0, 0);
        columns[4 * i + 1].unknown = control_unknown(h, 1, 0);
        columns[4 * i + 2].unknown = control_unknown(fan.sectors[(i + n - 1) % n], 0, 1);
        columns[4 * i + 3].unknown = control_unknown(h, 1, 1);
    }
    apex_[fan.vertex] = mask_row(mask.apex, columns);
    if (n == 4)
        return; // regular: the quadratic spline is smooth as it is
    for (Index i = 0; i < n; ++i) {
        const Index h = fan.sectors[i];
        const Index rows = mask_row(mask.edge1[i], columns);
        mask_row(mask.edge2[i], columns);
        edge_end_[end_of(h)] = rows;
        corner_piece_[h] = mask_row(mask.b11[i], columns);
        for (const auto* part : {&mask.b21, &mask.b12, &mask.b22})
            mask_row((*part)[i], columns);
    }
}

void EckHoppeAssembly::build(const std::vector<Fan>& fans, SplineNetwork& network)
{
    for (std::size_t i = 0; i < control_.size(); ++i)
        control_[i] = new_unit_row(true);
    std::map<Index, EckHoppeMask> masks;
    for (const Fan& fan : fans) {
        const auto [it, fresh] = masks.try_emplace(fan.sector_count(), EckHoppeMask{});
        if (fresh)
            it->second = eck_hoppe_mask(fan.sector_count());
        apply_mask(fan, it->second);
        add_even_constraint(fan, network.constraints);
    }
    add_patches(network);
}

//! Why the masks of Eck and Hoppe do not cover a domain, if they do not.
Status refusal(const std::vector<Fan>& fans)
{
    for (const Fan& fan : fans) {
        if (fan.kind != FanKind::closed) {
            return Error{ErrorCode::invalid_domain,
                         "the scheme eck-hoppe covers closed smooth domains only, but vertex " +
                             std::to_string(fan.vertex) +
                             " lies on a boundary or crease; use the scheme peters",
                         fan.vertex};
        }
    }
    return {};
}

} // namespace

Status build_eck_hoppe(const QuadComplex& complex, const std::vector<Fan>& fans,
                       SplineNetwork& network)
{
    if (Status refused = refusal(fans))
        return refused;
    EckHoppeAssembly(complex).build(fans, network);
    return {};
}

} // namespace bot2nurbs
