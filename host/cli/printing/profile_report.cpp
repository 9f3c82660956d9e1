#include "cli/printing/profile_report.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

namespace moclean::cli {
namespace {

struct Rates {
  double flops = 0, bytes = 0;  // per second
  double share_of_peak = 0;
};

// In mixed precision only the sweeps calculate in float.
double peak_flops(const KernelProfile& kernel, const ProfileReport& report) {
  const bool floats = report.precision == Precision::mixed && kernel.kernel.starts_with("sweep");
  return floats ? report.peak.float_flops : report.peak.double_flops;
}

std::optional<Rates> rates_of(const KernelProfile& kernel, const ProfileReport& report) {
  if (!kernel.work || kernel.seconds <= 0) return std::nullopt;
  Rates rates{.flops = kernel.work->flops / kernel.seconds,
              .bytes = kernel.work->bytes / kernel.seconds};
  rates.share_of_peak =
      std::max(rates.flops / peak_flops(kernel, report), rates.bytes / report.peak.bytes);
  return rates;
}

double share(double seconds, const ProfileReport& report) {
  return report.solve_seconds > 0 ? seconds / report.solve_seconds : 0;
}

double kernel_seconds(const ProfileReport& report) {
  double sum = 0;
  for (const KernelProfile& kernel : report.kernels) sum += kernel.seconds;
  return sum;
}

// Of the solve time.
double kernel_share(const KernelProfile& kernel, const ProfileReport& report) {
  const double sum = kernel_seconds(report);
  return sum > 0 ? kernel.seconds / sum * share(report.busy_seconds, report) : 0;
}

std::string line(const KernelProfile& kernel, const ProfileReport& report) {
  std::string text = fmt::format("{:<22}{:>8}{:>12.2f}{:>8.1f}", kernel.kernel, kernel.calls,
                                 1e3 * kernel.seconds, 100 * kernel_share(kernel, report));
  if (const auto rates = rates_of(kernel, report))
    text += fmt::format("{:>9.2f}{:>9.2f}{:>8.1f}\n", 1e-9 * rates->flops, 1e-9 * rates->bytes,
                        100 * rates->share_of_peak);
  else
    text += fmt::format("{:>9}{:>9}{:>8}\n", "-", "-", "-");
  return text;
}

}  // namespace

std::string profile_table(const ProfileReport& report) {
  std::string text = fmt::format("{:<22}{:>8}{:>12}{:>8}{:>9}{:>9}{:>8}\n", "kernel", "calls", "ms",
                                 "% time", "GF/s", "GB/s", "% peak");
  for (const KernelProfile& kernel : report.kernels) text += line(kernel, report);
  const double rest = report.solve_seconds - report.busy_seconds;
  text += fmt::format("{:<22}{:>8}{:>12.2f}{:>8.1f}\n", "(outside kernels)", "", 1e3 * rest,
                      100 * share(rest, report));
  text += fmt::format("sum of all kernels: {:.2f} ms in {:.2f} ms\n", 1e3 * kernel_seconds(report),
                      1e3 * report.busy_seconds);
  const Peak& peak = report.peak;
  text += fmt::format("peak of the device: {:.1f} GF/s double, {:.1f} GF/s float, {:.1f} GB/s\n",
                      1e-9 * peak.double_flops, 1e-9 * peak.float_flops, 1e-9 * peak.bytes);
  return text;
}

Json profile_record(const ProfileReport& report) {
  Json record;
  record["solve_seconds"] = report.solve_seconds;
  record["kernel_seconds"] = kernel_seconds(report);
  record["busy_seconds"] = report.busy_seconds;
  record["peak"] = {{"double_flops", report.peak.double_flops},
                    {"float_flops", report.peak.float_flops},
                    {"bytes", report.peak.bytes}};
  record["kernels"] = Json::array();
  for (const KernelProfile& kernel : report.kernels) {
    Json entry{{"kernel", kernel.kernel}, {"calls", kernel.calls}, {"seconds", kernel.seconds}};
    entry["share_of_time"] = kernel_share(kernel, report);
    const auto rates = rates_of(kernel, report);
    entry["flops_per_second"] = rates ? Json(rates->flops) : Json(nullptr);
    entry["bytes_per_second"] = rates ? Json(rates->bytes) : Json(nullptr);
    entry["share_of_peak"] = rates ? Json(rates->share_of_peak) : Json(nullptr);
    record["kernels"].push_back(std::move(entry));
  }
  return record;
}

}  // namespace moclean::cli
