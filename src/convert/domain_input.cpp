// SPDX-License-Identifier: MIT
#include "convert/domain_input.h"

#include "bot2nurbs/convert.h"
#include "bot2nurbs/domain_file.h"
#include "bot2nurbs/validate_domain.h"
#include "convert/component_file.h"
#include "convert/input.h"

#include <fmt/format.h>
#include <utility>

namespace bot2nurbs {

namespace {

Result<std::vector<QuadDomain>> read_domains(const std::string& path, const RepairedMesh& mesh)
{
    return read_for_components(path, mesh, domains_from_json);
}

std::optional<Error> first_defect(const std::string& path, const DomainValidation& validation)
{
    if (validation.valid())
        return std::nullopt;
    const DomainDefect& d = validation.defects.front();
    const std::size_t others = validation.defect_count - 1;
    const std::string more = others == 0 ? std::string() : fmt::format(" (and {} more)", others);
    return in_file(path,
                   {ErrorCode::invalid_domain,
                    fmt::format("{}: {}{}. --validate-domain lists all", d.rule, d.message, more),
                    d.element});
}

} // namespace

Result<std::vector<QuadDomain>> valid_domains(const std::string& path, const RepairedMesh& mesh,
                                              Context& context)
{
    context.begin_stage("domain");
    Result<std::vector<QuadDomain>> domains = read_domains(path, mesh);
    if (!domains)
        return domains;
    ValidateOptions options;
    options.charts = false;
    for (std::size_t c = 0; c < domains->size(); ++c) {
        const Result<DomainValidation> validation =
            validate_domain(mesh.components[c].mesh, (*domains)[c], context, options);
        if (!validation)
            return validation.error();
        if (const std::optional<Error> defect = first_defect(path, *validation))
            return *defect;
    }
    return domains;
}

Result<DomainFileReport> check_domain(const ConvertOptions& options, Context& context)
{
    if (!options.domain_in)
        return Error{ErrorCode::bad_option, "no domain file is named", invalid_index};
    const Result<PreparedInput> input = prepare_input(options, context);
    if (!input)
        return input.error();
    context.begin_stage("domain");
    DomainFileReport report;
    const Result<std::vector<QuadDomain>> domains = read_domains(*options.domain_in, input->mesh);
    if (!domains) {
        const ErrorCode code = domains.error().code;
        if (code != ErrorCode::stale_domain && code != ErrorCode::invalid_domain)
            return domains.error();
        report.rejection = domains.error();
        return report;
    }
    for (std::size_t c = 0; c < domains->size(); ++c) {
        Result<DomainValidation> validation =
            validate_domain(input->mesh.components[c].mesh, (*domains)[c], context);
        if (!validation)
            return validation.error();
        if (!report.rejection)
            report.rejection = first_defect(*options.domain_in, *validation);
        report.components.push_back(std::move(*validation));
    }
    context.end_stage();
    return report;
}

} // namespace bot2nurbs
