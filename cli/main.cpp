// SPDX-License-Identifier: MIT
#include "command.h"
#include "summary.h"
#include "terminal.h"

#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>
#include <limits>
#include <new>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace bot2nurbs::cli {

namespace {

// All files are written, but a component is not within the tolerance.
constexpr int exit_tolerance_not_met = 7;

// What Ctrl-C cancels. Read by the signal handler.
std::atomic<Context*> interruptible{nullptr};

extern "C" void interrupt(int)
{
    if (Context* context = interruptible.load())
        context->cancel();
}

//! The first signal cancels and leaves nothing half-written; a second one kills.
void cancel_on_signals(Context& context)
{
    interruptible.store(&context);
    struct sigaction action = {};
    action.sa_handler = interrupt;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

//! Large arrays come and go from stage to stage. Given back to the system each time, their pages
//! would have to be cleared and mapped again, which shows on meshes of a million triangles.
void keep_memory()
{
#ifdef __GLIBC__
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

int fail(const Error& error, Terminal& terminal)
{
    terminal.error(error.message);
    return exit_code(error.code);
}

//! Writes the report where --json asked for it. Returns the exit code.
int put_report(const std::string& json, const std::string& path, Terminal& terminal)
{
    if (path == "-") {
        const bool written = std::fwrite(json.data(), 1, json.size(), stdout) == json.size() &&
                             std::fflush(stdout) == 0;
        return written ? 0
                       : fail({ErrorCode::cannot_write, "cannot write to standard output",
                               invalid_index},
                              terminal);
    }
    if (const Status failed = write_report(json, path))
        return fail(*failed, terminal);
    return 0;
}

int run_convert(const Command& command, Context& context, Terminal& terminal)
{
    const Result<ConvertReport> report = convert(command.options, context);
    terminal.clear();
    if (!report) {
        const int code = fail(report.error(), terminal);
        if (!command.json.empty())
            put_report(failure_to_json(command.options, report.error(), context.stages()),
                       command.json, terminal);
        return code;
    }
    for (const Warning& warning : report->warnings)
        terminal.warning(warning.message);
    if (terminal.verbose())
        for (const std::string& line : stage_lines(report->stages))
            terminal.line(line);
    for (const std::string& line : summarise(*report))
        terminal.line(line);
    if (!command.json.empty())
        if (const int code =
                put_report(report_to_json(command.options, *report), command.json, terminal))
            return code;
    return report->tolerance_met() ? 0 : exit_tolerance_not_met;
}

//! The end of --check and --validate-domain. Their report is the data that was asked for: it goes
//! to standard output, unless JSON goes there.
int put_verdict(const std::vector<std::string>& lines, const std::string& json,
                const std::optional<Error>& rejection, const Command& command, Terminal& terminal)
{
    if (command.json != "-")
        for (const std::string& line : lines)
            std::printf("%s\n", line.c_str());
    if (!command.json.empty())
        if (const int code = put_report(json, command.json, terminal))
            return code;
    return rejection ? exit_code(rejection->code) : 0;
}

int run_check(const Command& command, Context& context, Terminal& terminal)
{
    const Result<InputReport> report = check_input(command.options, context);
    terminal.clear();
    if (!report)
        return fail(report.error(), terminal);
    return put_verdict(describe(command.options, *report),
                       input_report_to_json(command.options, *report), report->rejection, command,
                       terminal);
}

int run_validate(const Command& command, Context& context, Terminal& terminal)
{
    const Result<DomainFileReport> report = check_domain(command.options, context);
    terminal.clear();
    if (!report)
        return fail(report.error(), terminal);
    return put_verdict(describe(*report), domain_report_to_json(command.options, *report),
                       report->rejection, command, terminal);
}

int run(const Command& command)
{
    Context context;
    context.threads = command.threads;
    Terminal terminal(command.quiet, command.verbose);
    terminal.attach(context);
    cancel_on_signals(context);
    int code = 0;
    try {
        switch (command.action) {
        case Action::convert: code = run_convert(command, context, terminal); break;
        case Action::check: code = run_check(command, context, terminal); break;
        case Action::validate_domain: code = run_validate(command, context, terminal); break;
        }
    } catch (const std::bad_alloc&) {
        code = fail({ErrorCode::internal, "out of memory", invalid_index}, terminal);
    } catch (const std::exception& error) {
        code = fail(
            {ErrorCode::internal, std::string("internal error: ") + error.what(), invalid_index},
            terminal);
    }
    interruptible.store(nullptr);
    return code;
}

} // namespace

} // namespace bot2nurbs::cli

int main(int argc, char** argv)
{
    using namespace bot2nurbs::cli;
    const std::variant<Command, int> command = parse_command(argc, argv);
    if (const int* code = std::get_if<int>(&command))
        return *code;
    keep_memory();
    return run(std::get<Command>(command));
}
