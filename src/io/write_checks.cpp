// SPDX-License-Identifier: MIT
#include "io/write_checks.h"

#include "brep/brep_rules.h"

#include <algorithm>
#include <array>

namespace bot2nurbs {

Status WriteOptions::check() const
{
    constexpr std::array<int, 5> versions{4, 50, 60, 70, 80};
    if (std::find(versions.begin(), versions.end(), archive_version) == versions.end()) {
        return Error{ErrorCode::bad_option,
                     "archive version " + std::to_string(archive_version) +
                         " is not one of 4, 50, 60, 70, 80",
                     invalid_index};
    }
    constexpr std::array<const char*, 9> names{"", "um", "mm", "cm", "m", "km", "in", "ft", "mi"};
    if (std::find(names.begin(), names.end(), units) == names.end()) {
        return Error{ErrorCode::bad_option,
                     "unit \"" + units + "\" is not one of um, mm, cm, m, km, in, ft, mi",
                     invalid_index};
    }
    return {};
}

Status check_writable(const std::vector<Brep>& breps, const WriteOptions& options)
{
    if (Status error = options.check())
        return error;
    if (breps.empty())
        return Error{ErrorCode::empty_input, "there is no B-Rep to write", invalid_index};
    for (const Brep& brep : breps) {
        DefectList defects;
        check_indices(brep, defects);
        check_splines(brep, defects);
        if (defects.empty())
            check_lists(brep, defects);
        if (!defects.empty()) {
            const BrepDefect first = defects.take().front();
            return Error{ErrorCode::brep_failed, first.rule + ": " + first.message, first.element};
        }
    }
    return {};
}

} // namespace bot2nurbs
