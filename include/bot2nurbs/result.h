// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace bot2nurbs {

//! Index of an element in a flat array (vertex, halfedge, face, patch, ...).
using Index = std::uint32_t;

//! The index that names no element.
inline constexpr Index invalid_index = 0xffffffffu;

//! Why a call could not do its job. `exit_code()` maps each to the command's exit code.
enum class ErrorCode {
    internal,            //!< A guarantee of ours did not hold: a bug in bot2nurbs.
    bad_option,          //!< An option is out of its range or contradicts another.
    cannot_read,         //!< A file is missing, truncated, or not in the format it claims.
    cannot_write,        //!< A file cannot be created, written or renamed.
    empty_input,         //!< There is nothing to work on.
    bad_geometry,        //!< Non-finite coordinates, or all points on one point or line.
    not_manifold,        //!< An edge or vertex is not two-manifold.
    not_orientable,      //!< Faces cannot be oriented consistently.
    open_mesh,           //!< The mesh has boundary loops where a closed one is needed.
    self_intersecting,   //!< Faces cross each other and `strict` was asked for.
    stale_domain,        //!< A domain or constraint file belongs to another mesh.
    invalid_domain,      //!< A supplied domain fails validation.
    constraint_conflict, //!< Constraints contradict each other or the mesh.
    layout_failed,       //!< No quadrilateral layout was found.
    fit_failed,          //!< The fitting system could not be solved.
    brep_failed,         //!< The assembled B-Rep failed its checks.
    cancelled,           //!< The caller cancelled; nothing was written.
};

//! An error: what, where (the first bad element, in the numbering the message names), what to do.
struct Error {
    ErrorCode code = ErrorCode::internal;
    std::string message;
    Index element = invalid_index;
};

//! Exit code of the command for an error (documented in README, "Exit codes").
int exit_code(ErrorCode code);

//! Short stable name of an error code, as used in reports ("not_manifold").
const char* name(ErrorCode code);

//! A value, or the reason why there is none.
template <class T> class [[nodiscard]] Result {
public:
    Result(T value) : data_(std::in_place_index<0>, std::move(value)) {}     // NOLINT
    Result(Error error) : data_(std::in_place_index<1>, std::move(error)) {} // NOLINT

    bool ok() const { return data_.index() == 0; }
    explicit operator bool() const { return ok(); }

    //! \pre ok()
    T& value()
    {
        assert(ok());
        return std::get<0>(data_);
    }
    const T& value() const
    {
        assert(ok());
        return std::get<0>(data_);
    }
    T& operator*() { return value(); }
    const T& operator*() const { return value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    //! \pre !ok()
    const Error& error() const
    {
        assert(!ok());
        return std::get<1>(data_);
    }

private:
    std::variant<T, Error> data_;
};

//! Success, or the reason why not.
using Status = std::optional<Error>;

} // namespace bot2nurbs
