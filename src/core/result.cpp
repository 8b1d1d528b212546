// SPDX-License-Identifier: MIT
#include "bot2nurbs/result.h"

namespace bot2nurbs {

int exit_code(ErrorCode code)
{
    switch (code) {
    case ErrorCode::internal: return 1;
    case ErrorCode::bad_option: return 2;
    case ErrorCode::cannot_read: return 3;
    case ErrorCode::cannot_write: return 4;
    case ErrorCode::empty_input:
    case ErrorCode::bad_geometry:
    case ErrorCode::not_manifold:
    case ErrorCode::not_orientable:
    case ErrorCode::open_mesh:
    case ErrorCode::self_intersecting:
    case ErrorCode::stale_domain:
    case ErrorCode::invalid_domain:
    case ErrorCode::constraint_conflict: return 5;
    case ErrorCode::layout_failed:
    case ErrorCode::fit_failed:
    case ErrorCode::brep_failed: return 6;
    case ErrorCode::cancelled: return 130;
    }
    return 1;
}

const char* name(ErrorCode code)
{
    switch (code) {
    case ErrorCode::internal: return "internal";
    case ErrorCode::bad_option: return "bad_option";
    case ErrorCode::cannot_read: return "cannot_read";
    case ErrorCode::cannot_write: return "cannot_write";
    case ErrorCode::empty_input: return "empty_input";
    case ErrorCode::bad_geometry: return "bad_geometry";
    case ErrorCode::not_manifold: return "not_manifold";
    case ErrorCode::not_orientable: return "not_orientable";
    case ErrorCode::open_mesh: return "open_mesh";
    case ErrorCode::self_intersecting: return "self_intersecting";
    case ErrorCode::stale_domain: return "stale_domain";
    case ErrorCode::invalid_domain: return "invalid_domain";
    case ErrorCode::constraint_conflict: return "constraint_conflict";
    case ErrorCode::layout_failed: return "layout_failed";
    case ErrorCode::fit_failed: return "fit_failed";
    case ErrorCode::brep_failed: return "brep_failed";
    case ErrorCode::cancelled: return "cancelled";
    }
    return "internal";
}

} // namespace bot2nurbs
