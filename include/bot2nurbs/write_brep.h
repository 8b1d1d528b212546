// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/brep.h"

#include <string>
#include <vector>

namespace bot2nurbs {

//! Application protocol of a STEP file (ISO 10303).
enum class StepSchema {
    ap242, //!< AP242 managed model based 3D engineering.
    ap214, //!< AP214 automotive design, for older readers.
};

//! How B-Reps are written. Fields that a format has no place for are ignored by it.
struct WriteOptions {
    //! .3dm archive version: 4, 50, 60, 70 or 80. A reader opens its own version and older ones;
    //! 50 is Rhino 5 and later.
    int archive_version = 50;
    StepSchema step_schema = StepSchema::ap242;
    //! Unit of the coordinates: "um", "mm", "cm", "m", "km", "in", "ft" or "mi"; empty:
    //! millimetres. Coordinates are written as they are and the file says the unit. `.brep` has no
    //! unit.
    std::string units;
    //! Name of the file's contents in the header of a STEP file.
    std::string title = "bot2nurbs";

    //! The first field that is out of its range.
    Status check() const;
};

//! Writes B-Reps as objects of one openNURBS archive, each with its name. Ids are made from the
//! contents, so equal input gives equal bytes.
//! The file appears whole or not at all; a file that was there stays as it was on any error.
//! Errors: bad_option, empty_input (no B-Reps), brep_failed (indices out of range), cannot_write.
Status write_3dm(const std::vector<Brep>& breps, const std::string& path,
                 const WriteOptions& options = {});

//! Writes B-Reps as solids (open ones as shells) of one STEP file, each a product with its name.
//! The header has no clock and no machine name: equal input gives equal bytes. Faces, edges and
//! vertices are shared as in the B-Rep; parts of one B-Rep that are not connected become solids of
//! their own, inward oriented parts hollows of the solid around them.
//! Not reentrant inside Open CASCADE: calls wait for each other. Errors: as write_3dm.
Status write_step(const std::vector<Brep>& breps, const std::string& path,
                  const WriteOptions& options = {});

//! Writes B-Reps as an Open CASCADE .brep file: one solid, or a compound of several.
//! Errors: as write_3dm.
Status write_occ_brep(const std::vector<Brep>& breps, const std::string& path,
                      const WriteOptions& options = {});

//! The bytes that the writers write.
Result<std::string> brep_to_3dm(const std::vector<Brep>& breps, const WriteOptions& options = {});
Result<std::string> brep_to_step(const std::vector<Brep>& breps, const WriteOptions& options = {});
Result<std::string> brep_to_occ_brep(const std::vector<Brep>& breps,
                                     const WriteOptions& options = {});

} // namespace bot2nurbs
