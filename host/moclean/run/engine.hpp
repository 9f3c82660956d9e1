#pragma once

#include <stop_token>

#include "moclean/backend/backend.hpp"
#include "moclean/run/events.hpp"
#include "moclean/run/job.hpp"
#include "moclean/run/run_report.hpp"

namespace moclean {

/// Reads, solves and writes all takes of a job, batch after batch: while one is solved, the next
/// ones are read and the ones before it written, in bounded memory (see TakeReader). Without
/// Job::overlap all are read, then solved, then written. How takes are put together does not change
/// the results. Prints nothing: who wants to know how far it is gives a sink.
///
/// With FailurePolicy::all_or_nothing the results appear under their names when all takes are done;
/// if anything fails, or a stop is requested, none does, and it throws what the stages throw: Error
/// if Job::verify finds a difference, Cancelled. With each_on_its_own the results of a take appear
/// when it is done; one that fails has its TakeReport::failure, and what throws is only what
/// concerns all: a folder that cannot be made, and Cancelled, after which the takes that were
/// written stay.
RunReport run_job(const Job& job, Backend& backend, const EventSink& sink = {},
                  const std::stop_token& stop = {});

}  // namespace moclean
