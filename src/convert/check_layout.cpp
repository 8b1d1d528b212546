// SPDX-License-Identifier: MIT
#include "convert/check_layout.h"

#include <fmt/format.h>
#include <utility>

namespace bot2nurbs {

namespace {

Error bad_option(std::string message)
{
    return {ErrorCode::bad_option, std::move(message), invalid_index};
}

} // namespace

std::optional<Error> check_layout(const ConvertOptions& o)
{
    const std::pair<bool, const char*> sources[] = {{o.cage, "--cage"},
                                                    {o.quads.has_value(), "--layout quads"},
                                                    {o.domain_in.has_value(), "--domain-in"}};
    const std::pair<bool, const char*> automatic[] = {
        {o.patches.has_value(), "--patches"},
        {o.constraints.has_value(), "--constraints"},
        {o.constraints_out.has_value(), "--constraints-out"}};
    const std::pair<bool, const char*> of_mesh[] = {
        {o.domain_out.has_value(), "--domain-out"},
        {o.fill_holes.has_value(), "--fill-holes"},
        {o.weld.has_value(), "--weld"},
        {o.components == ComponentMode::largest, "--components largest"},
        {o.features == FeatureMode::all, "--features DEGREES"},
        {o.strict, "--strict"}};
    const char* source = nullptr;
    for (const auto& [given, name] : sources) {
        if (given && source)
            return bad_option(fmt::format("{} contradicts {}: both are layouts", name, source));
        if (given)
            source = name;
    }
    for (const auto& [given, name] : automatic)
        if (given && source)
            return bad_option(
                fmt::format("{} is about the automatic layout: it contradicts {}", name, source));
    for (const auto& [given, name] : of_mesh)
        if (given && o.cage)
            return bad_option(fmt::format("{} is about a mesh, but --cage has none", name));
    return std::nullopt;
}

} // namespace bot2nurbs
