#include "cli/printing/json_record.hpp"

#include <cstdio>

#include <fmt/format.h>

#include "moclean/core/version.hpp"
#include "moclean/denoise/sample_status.hpp"
#include "moclean/formats/file.hpp"

#include "cli/backend/tuning_cache.hpp"
#include "cli/printing/backend_report.hpp"
#include "cli/printing/standard_output.hpp"

namespace moclean::cli {
namespace {

Json segmentation_record(const Segmentation& segmentation) {
  if (segmentation.whole) return {{"whole", true}};
  Json record;
  if (segmentation.segments > 0)
    record["segments"] = segmentation.segments;
  else
    record["length"] = segmentation.length;
  record["overlap"] = segmentation.overlap;
  record["automatic"] = segmentation.cheapest;
  return record;
}

// lambda is null where it follows from lambda_scale and the size of the segment.
void add_robust_pca(Json& record, const RobustPca& method) {
  record["lambda"] = method.lambda > 0 ? Json(method.lambda) : Json(nullptr);
  record["lambda_scale"] = method.lambda_scale;
  record["rho"] = method.rho;
  record["mu0_factor"] = method.mu0_factor;
  record["mu_max_factor"] = method.mu_max_factor;
  record["tolerance"] = method.tolerance;
  record["max_iterations"] = method.max_iterations;
  record["order"] = to_string(method.order);
}

// The name of the only step, else the whole chain; `specification` gives the same run everywhere.
Json method_record(const DenoiseOptions& options) {
  const Chain& chain = options.chain;
  Json record;
  record["name"] = chain.size() == 1 ? name_of(chain.front()) : to_string(chain);
  record["specification"] = to_string(chain);
  for (const Step& step : chain)
    if (const auto* automatic = std::get_if<Automatic>(&step)) {
      const auto chosen = [](const auto& names, auto value) {
        return std::string(names[static_cast<std::size_t>(value)]);
      };
      record["reject"] = chosen(Automatic::rejections, automatic->reject);
      record["smooth"] = chosen(Automatic::choices, automatic->smooth);
    }
  const LowRank* method = first_low_rank(chain);
  if (!method) return record;
  record["segmentation"] = segmentation_record(method->segmentation);
  if (const auto* robust_pca = std::get_if<RobustPca>(&method->method))
    add_robust_pca(record, *robust_pca);
  return record;
}

Json segment_record(const DenoisedSegment& segment) {
  Json record;
  record["first_frame"] = segment.first_frame;
  record["frames"] = segment.frames;
  record["iterations"] = segment.outcome.iterations;
  const SegmentOutcome& outcome = segment.outcome;
  const bool iterates = !outcome.fixed_steps;
  record["rank"] = outcome.rank ? Json(*outcome.rank) : Json(nullptr);
  record["residual"] = iterates ? Json(outcome.residual) : Json(nullptr);
  record["converged"] = iterates ? Json(outcome.converged) : Json(nullptr);
  return record;
}

Json agreement_record(const Verification& verification) {
  Json record;
  record["low_rank"] = verification.agreement.low_rank;
  record["sparse"] = verification.agreement.sparse;
  record["largest_difference"] = verification.largest_difference;
  record["same_iterations"] = verification.agreement.iterations_apart == 0;
  record["same_rank"] = verification.agreement.ranks_apart == 0;
  return record;
}

// null where nothing was moved, or there is no body to compare with.
Json change_record(const Change& changed) {
  Json record;
  record["corrected"] = changed.corrected;
  record["filled"] = changed.filled;
  record["largest"] = nullptr;
  if (changed.largest.distance == 0) return record;
  const bool sized = changed.body_size > 0;
  record["largest"] = {{"distance", changed.largest.distance},
                       {"share_of_body", sized ? Json(changed.largest_share()) : Json(nullptr)},
                       {"joint", changed.largest.joint},
                       {"frame", changed.largest.frame}};
  return record;
}

}  // namespace

Json take_record(const TakeReport& take) {
  Json record;
  record["file"] = take.file.string();
  if (!take.failure.empty()) {
    record["error"] = take.failure;
    return record;
  }
  record["frames"] = take.frames;
  record["columns"] = take.columns;
  record["seconds"]["read"] = take.read_seconds;
  record["seconds"]["solve"] = take.solve_seconds;
  record["seconds"]["write"] = take.write_seconds;
  record["frames_per_second"] = take.frames_per_second();
  for (std::size_t s = 0; s < take.status.size(); ++s)
    record["samples"][sample_status_names[s]] = take.status[s];
  record["changed"] = change_record(take.changed);
  record["segments"] = Json::array();
  for (const DenoisedSegment& segment : take.segments)
    record["segments"].push_back(segment_record(segment));
  if (!take.notes.layout.empty()) record["layout"] = take.notes.layout;
  if (!take.notes.warnings.empty()) record["warnings"] = take.notes.warnings;
  if (!take.notes.passed_through.empty()) record["passed_through"] = take.notes.passed_through;
  if (!take.unobserved.empty()) record["unobserved_columns"] = take.unobserved;
  if (take.truth)
    record["truth"] = {{"file", take.truth->file.string()},
                       {"fd_noisy", take.truth->fd_noisy},
                       {"fd_clean", take.truth->fd_clean}};
  if (take.verification) record["agreement"] = agreement_record(*take.verification);
  return record;
}

Json json_record(const DenoiseOptions& options, const BackendReport& backend,
                 const RunReport& run) {
  Json record;
  record["version"] = version();
  record["device"] = backend.name;
  record["precision"] = to_string(options.precision);
  if (backend.tuning) record["tuning"] = tuning_record(*backend.tuning);
  if (backend.tuning)
    record["tuning"]["file"] =
        backend.tuning_file.empty() ? Json(nullptr) : Json(backend.tuning_file.string());
  record["method"] = method_record(options);
  record["seconds"] = {{"read", run.seconds.read},
                       {"solve", run.seconds.solve},
                       {"write", run.seconds.write},
                       {"total", run.seconds.total}};
  record["memory"] = {{"limit", options.memory_limit}, {"peak", run.peak_memory}};
  record["groups"] = run.batches;
  record["inputs"] = Json::array();
  for (const TakeReport& take : run.takes) record["inputs"].push_back(take_record(take));
  if (backend.profile) record["profile"] = profile_record(*backend.profile);
  return record;
}

std::string to_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_json(const std::filesystem::path& file, const Json& json) {
  if (file == "-") {
    write_output(to_text(json));
    return;
  }
  AtomicFile target(file);
  target.write(to_text(json));
  target.commit();
}

}  // namespace moclean::cli
