// SPDX-License-Identifier: MIT
#include "bot2nurbs/write_brep.h"

#include "io/atomic_file.h"
#include "io/occ_shape.h"
#include "io/step_text.h"
#include "io/write_checks.h"

#include <APIHeaderSection_MakeHeader.hxx>
#include <Interface_FloatWriter.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <Standard_Failure.hxx>
#include <StepBasic_Product.hxx>
#include <StepData_Protocol.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_StepWriter.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepShape_ManifoldSolidBrep.hxx>
#include <StepShape_ShellBasedSurfaceModel.hxx>
#include <TCollection_HAsciiString.hxx>
#include <XSControl_WorkSession.hxx>

#include <exception>
#include <sstream>

namespace bot2nurbs {

namespace {

// Seventeen significant digits: every double comes back as it was.
constexpr const char* exact_real = "%.16E";

// ISO 10303-21 asks for a time; this one says that none is told.
constexpr const char* no_time = "1970-01-01T00:00:00";

//! Sets a parameter of Open CASCADE's exchange and puts the old value back in the end.
class ScopedParameter {
public:
    ScopedParameter(const char* name, const std::string& value)
        : name_(name), old_(Interface_Static::CVal(name))
    {
        Interface_Static::SetCVal(name, value.c_str());
    }
    ~ScopedParameter() { Interface_Static::SetCVal(name_, old_.c_str()); }
    ScopedParameter(const ScopedParameter&) = delete;
    ScopedParameter& operator=(const ScopedParameter&) = delete;

private:
    const char* name_;
    std::string old_;
};

//! Open CASCADE's name of a unit.
std::string occ_unit(const std::string& name)
{
    if (name.empty())
        return "MM";
    if (name == "in")
        return "INCH";
    std::string upper;
    for (char c : name)
        upper += static_cast<char>(c - 'a' + 'A');
    return upper;
}

Handle(TCollection_HAsciiString) text(const std::string& s)
{
    return new TCollection_HAsciiString(s.c_str());
}

//! Gives the product, and the solids and surface models that a transfer added, their name.
void name_items(const Handle(StepData_StepModel) & model, int first, const std::string& name)
{
    for (int i = first; i <= model->NbEntities(); ++i) {
        const Handle(Standard_Transient) entity = model->Value(i);
        const auto product = Handle(StepBasic_Product)::DownCast(entity);
        if (!product.IsNull()) {
            product->SetId(text(name));
            product->SetName(text(name));
        }
        const auto item = Handle(StepRepr_RepresentationItem)::DownCast(entity);
        if (!item.IsNull() && (item->IsKind(STANDARD_TYPE(StepShape_ManifoldSolidBrep)) ||
                               item->IsKind(STANDARD_TYPE(StepShape_ShellBasedSurfaceModel))))
            item->SetName(text(name));
    }
}

void write_header(const Handle(StepData_StepModel) & model, const std::string& title)
{
    APIHeaderSection_MakeHeader header(model);
    header.SetName(text(title));
    header.SetTimeStamp(text(no_time));
    header.SetAuthorValue(1, text(""));
    header.SetOrganizationValue(1, text(""));
    header.SetPreprocessorVersion(text("Open CASCADE Technology"));
    header.SetOriginatingSystem(text("bot2nurbs"));
    header.SetAuthorisation(text(""));
    header.SetDescriptionValue(1, text("Boundary representation of bicubic B-spline patches"));
}

Error step_failed(const std::string& reason)
{
    return {ErrorCode::internal, "Open CASCADE could not make the STEP model: " + reason,
            invalid_index};
}

Result<std::string> make_step(const std::vector<Brep>& breps, const WriteOptions& options)
{
    STEPControl_Controller::Init();
    const std::string unit = occ_unit(options.units);
    // The same unit outside and inside: coordinates are not scaled.
    const ScopedParameter outside("write.step.unit", unit), inside("xstep.cascade.unit", unit);
    const ScopedParameter schema("write.step.schema",
                                 options.step_schema == StepSchema::ap242 ? "AP242DIS" : "AP214IS");

    std::vector<std::string> names{options.title};
    STEPControl_Writer writer;
    const Handle(StepData_StepModel) model = writer.Model(true);
    for (std::size_t i = 0; i < breps.size(); ++i) {
        const Result<TopoDS_Shape> shape = brep_to_shape(breps[i]);
        if (!shape)
            return shape.error();
        // Names go in as marks: Open CASCADE numbers products and knows ASCII alone.
        names.push_back(breps[i].name.empty() ? "solid " + std::to_string(i + 1) : breps[i].name);
        const int before = model->NbEntities();
        // No graph of references: it is made anew of all objects at each one, and nothing asks it.
        const bool graph = false;
        if (writer.Transfer(*shape, STEPControl_AsIs, graph) != IFSelect_RetDone)
            return step_failed("object " + std::to_string(i) + " was not transferred");
        name_items(model, before + 1, step_name_mark(i + 1));
    }
    write_header(model, step_name_mark(0));

    StepData_StepWriter out(model);
    out.FloatWriter().SetFormat(exact_real);
    out.FloatWriter().SetZeroSuppress(false); // it cuts off exponents of long numbers
    out.SendModel(Handle(StepData_Protocol)::DownCast(writer.WS()->Protocol()));
    std::ostringstream stream;
    if (!out.Print(stream))
        return step_failed("it could not be printed");
    return finish_step_text(stream.str(), names);
}

} // namespace

Result<std::string> brep_to_step(const std::vector<Brep>& breps, const WriteOptions& options)
{
    if (Status error = check_writable(breps, options))
        return *error;
    const OccSession session;
    try {
        return make_step(breps, options);
    } catch (const Standard_Failure& failure) {
        return step_failed(failure.GetMessageString());
    } catch (const std::exception& failure) {
        return step_failed(failure.what());
    }
}

Status write_step(const std::vector<Brep>& breps, const std::string& path,
                  const WriteOptions& options)
{
    const Result<std::string> bytes = brep_to_step(breps, options);
    return bytes ? write_whole_file(path, *bytes) : Status(bytes.error());
}

} // namespace bot2nurbs
