// SPDX-License-Identifier: MIT
#include "bot2nurbs/context.h"

#include <chrono>
#include <sys/resource.h>

namespace bot2nurbs {

namespace {

double now_seconds()
{
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

double cpu_seconds()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double peak_rss_mib()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024.0; // Linux reports KiB.
}

} // namespace

void Context::begin_stage(const std::string& name)
{
    end_stage();
    stage_ = name;
    stage_start_ = now_seconds();
    stage_start_cpu_ = cpu_seconds();
    progress(0.0);
}

void Context::end_stage()
{
    if (stage_.empty())
        return;
    progress(1.0);
    stages_.push_back(
        {stage_, now_seconds() - stage_start_, peak_rss_mib(), cpu_seconds() - stage_start_cpu_});
    stage_.clear();
}

void Context::progress(double fraction)
{
    if (on_progress && !stage_.empty())
        on_progress(stage_, fraction);
}

void Context::log(LogLevel level, const std::string& message) const
{
    if (on_log)
        on_log(level, message);
}

} // namespace bot2nurbs
