// SPDX-License-Identifier: MIT
#pragma once

//! B-Reps as shapes of Open CASCADE, and what every use of that library here needs.

#include "bot2nurbs/brep.h"

#include <TopoDS_Shape.hxx>

#include <Message_SequenceOfPrinters.hxx>

#include <mutex>

namespace bot2nurbs {

//! The shape with the B-Rep's own sharing of faces, edges and vertices: a solid, a compound of
//! solids, or a shell where the B-Rep is not solid. Curves on faces are straight lines with the
//! parameter of the edge, so nothing is approximated.
//! Throws Standard_Failure. Error: brep_failed when an inward part has no part around it.
Result<TopoDS_Shape> brep_to_shape(const Brep& brep);

//! While it lives: this thread alone uses Open CASCADE's global state, and the library prints
//! nothing.
class OccSession {
public:
    OccSession();
    ~OccSession();
    OccSession(const OccSession&) = delete;
    OccSession& operator=(const OccSession&) = delete;

private:
    std::lock_guard<std::mutex> lock_;
    Message_SequenceOfPrinters printers_;
};

} // namespace bot2nurbs
