// SPDX-License-Identifier: MIT
#include "bot2nurbs/write_brep.h"

#include "io/atomic_file.h"
#include "io/occ_shape.h"
#include "io/write_checks.h"

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <Standard_Failure.hxx>
#include <TopoDS_Compound.hxx>

#include <exception>
#include <sstream>

namespace bot2nurbs {

namespace {

Error brep_file_failed(const std::string& reason)
{
    return {ErrorCode::internal, "Open CASCADE could not make the .brep file: " + reason,
            invalid_index};
}

Result<std::string> make_brep_file(const std::vector<Brep>& breps)
{
    const BRep_Builder builder;
    TopoDS_Compound compound;
    builder.MakeCompound(compound);
    TopoDS_Shape single;
    for (const Brep& brep : breps) {
        const Result<TopoDS_Shape> shape = brep_to_shape(brep);
        if (!shape)
            return shape.error();
        builder.Add(compound, *shape);
        single = *shape;
    }
    std::ostringstream stream;
    BRepTools::Write(breps.size() == 1 ? single : TopoDS_Shape(compound), stream);
    if (!stream)
        return brep_file_failed("it could not be printed");
    return stream.str();
}

} // namespace

Result<std::string> brep_to_occ_brep(const std::vector<Brep>& breps, const WriteOptions& options)
{
    if (Status error = check_writable(breps, options))
        return *error;
    const OccSession session;
    try {
        return make_brep_file(breps);
    } catch (const Standard_Failure& failure) {
        return brep_file_failed(failure.GetMessageString());
    } catch (const std::exception& failure) {
        return brep_file_failed(failure.what());
    }
}

Status write_occ_brep(const std::vector<Brep>& breps, const std::string& path,
                      const WriteOptions& options)
{
    const Result<std::string> bytes = brep_to_occ_brep(breps, options);
    return bytes ? write_whole_file(path, *bytes) : Status(bytes.error());
}

} // namespace bot2nurbs
