// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"

#include <algorithm>
#include <cstddef>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/task_arena.h>

namespace bot2nurbs {

//! Runs work() where loops inside use as many threads as the context allows.
template <class Work> void run_in_arena(const Context& context, const Work& work)
{
    // Inside an arena that is small enough already, the default one above all, another would cost
    // more than small loops take, and its threads would come on top.
    const int most = oneapi::tbb::this_task_arena::max_concurrency();
    if (context.threads == 0 || static_cast<unsigned>(most) <= context.threads) {
        work();
    } else {
        oneapi::tbb::task_arena arena(static_cast<int>(context.threads));
        arena.execute(work);
    }
}

//! Runs body(begin, end) over [0, count) in chunks of fixed size, on as many threads as the context
//! allows. Chunk borders depend on `count` and `chunk` alone, so a result stored per chunk and
//! combined in chunk order is the same for any thread count.
//!
//! \return false when the context was cancelled: some chunks may not have run. Polled before every
//! chunk, so a chunk should take well under 50 ms.
template <class Body>
bool for_each_chunk(const Context& context, std::size_t count, std::size_t chunk, const Body& body)
{
    const std::size_t chunks = (count + chunk - 1) / chunk;
    const auto run = [&](std::size_t c) {
        if (!context.cancelled())
            body(c * chunk, std::min(count, (c + 1) * chunk));
    };
    if (context.threads == 1 || chunks <= 1) {
        for (std::size_t c = 0; c < chunks; ++c)
            run(c);
        return !context.cancelled();
    }
    const auto run_all = [&] {
        oneapi::tbb::parallel_for(
            oneapi::tbb::blocked_range<std::size_t>(0, chunks, 1),
            [&](const oneapi::tbb::blocked_range<std::size_t>& range) {
                for (std::size_t c = range.begin(); c != range.end(); ++c)
                    run(c);
            },
            oneapi::tbb::simple_partitioner());
    };
    run_in_arena(context, run_all);
    return !context.cancelled();
}

//! Runs two functions that write to different places, at the same time where the context allows.
template <class First, class Second>
void run_both(const Context& context, const First& first, const Second& second)
{
    if (context.threads == 1) {
        first();
        second();
    } else {
        run_in_arena(context, [&] { oneapi::tbb::parallel_invoke(first, second); });
    }
}

} // namespace bot2nurbs
