// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/result.h"

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace bot2nurbs {

enum class LogLevel { info, warning };

//! Cost of one finished stage.
struct StageRecord {
    std::string name;
    double seconds = 0.0;
    double peak_rss_mib = 0.0; //!< Peak resident memory of the process when the stage ended.
    double cpu_seconds = 0.0;  //!< Processor time of all threads of the process in the stage.
};

//! Progress, cancellation, thread count and log sink of one conversion.
//!
//! `cancel()` may be called from any thread and from a signal handler. Long calls poll
//! `cancelled()` at least every 50 ms and then return ErrorCode::cancelled.
class Context {
public:
    using ProgressSink = std::function<void(const std::string& stage, double fraction)>;
    using LogSink = std::function<void(LogLevel, const std::string& message)>;

    ProgressSink on_progress; //!< Called from the calling thread only; may be empty.
    LogSink on_log;           //!< May be empty.
    unsigned threads = 0;     //!< 0: all cores. Results do not depend on it.

    void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
    bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }
    //! The error a cancelled stage returns.
    static Error cancelled_error(const std::string& stage)
    {
        return {ErrorCode::cancelled, "cancelled during " + stage, invalid_index};
    }

    //! Starts a stage and ends the one before.
    void begin_stage(const std::string& name);
    //! Ends the current stage, if any.
    void end_stage();
    //! Reports the fraction in [0, 1] of the current stage.
    void progress(double fraction);
    void log(LogLevel level, const std::string& message) const;

    const std::vector<StageRecord>& stages() const { return stages_; }

private:
    std::atomic<bool> cancelled_{false};
    std::string stage_;
    double stage_start_ = 0.0, stage_start_cpu_ = 0.0;
    std::vector<StageRecord> stages_;
};

} // namespace bot2nurbs
