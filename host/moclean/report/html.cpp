#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "moclean/core/error.hpp"
#include "moclean/report/assets.hpp"
#include "moclean/report/figures.hpp"
#include "moclean/report/quantised.hpp"
#include "moclean/report/report.hpp"

namespace moclean {
namespace {

using Json = nlohmann::ordered_json;

Json record(const Quantised& quantised) {
  return {
      {"offset", quantised.offset}, {"step", quantised.step}, {"codes", base64(quantised.codes)}};
}

// Which entries count as corrected: a bit each, frame after frame, lowest bit first.
std::string marks(const Mask& corrected) {
  std::vector<std::uint8_t> bits((static_cast<std::size_t>(corrected.size()) + 7) / 8);
  for (Index i = 0; i < corrected.size(); ++i)
    if (corrected.data()[i])
      bits[static_cast<std::size_t>(i / 8)] |= static_cast<std::uint8_t>(1U << (i % 8));
  return base64(bits);
}

Json record(const std::optional<BeforeAfter>& pair) {
  if (!pair) return nullptr;
  return {pair->noisy, pair->clean};
}

Json record(const ReportFigures& figures) {
  Json result = {{"threshold", figures.threshold},
                 {"corrected", figures.corrected},
                 {"filled", figures.filled},
                 {"left", figures.left},
                 {"correctedFrames", figures.corrected_frames},
                 {"observed", figures.observed},
                 {"fd", record(figures.fd)},
                 {"nearerFrames", figures.nearer_frames},
                 {"nearerJoints", figures.nearer_joints},
                 {"roughness", record(std::optional(figures.roughness))},
                 {"perFrame", record(quantise(figures.per_frame))}};
  for (const ReportFigures::JointFigure& joint : figures.joints)
    result["joints"].push_back({{"correction", joint.correction}, {"error", record(joint.error)}});
  result["opening"] = nullptr;
  if (figures.opening.frame >= 0)
    result["opening"] = {{"frame", figures.opening.frame}, {"joint", figures.opening.joint}};
  result["worstFrames"] = Json::array();
  for (const ReportFigures::WorstFrame& worst : figures.worst_frames)
    result["worstFrames"].push_back(
        {{"frame", worst.frame}, {"joint", worst.joint}, {"correction", worst.correction}});
  return result;
}

Json record(const DenoisedSegment& segment) {
  const SegmentOutcome& outcome = segment.outcome;
  const bool iterates = !outcome.fixed_steps;
  return {{"first", segment.first_frame},
          {"frames", segment.frames},
          {"iterations", outcome.iterations},
          {"rank", outcome.rank ? Json(*outcome.rank) : Json(nullptr)},
          {"residual", iterates ? Json(outcome.residual) : Json(nullptr)},
          {"converged", iterates ? Json(outcome.converged) : Json(nullptr)}};
}

void require_parents(const ReportTake& take, std::size_t joint_count) {
  if (take.parents.empty()) return;
  const bool all_known = std::ranges::all_of(take.parents, [&](int parent) {
    return parent >= -1 && parent < static_cast<int>(joint_count);
  });
  if (take.parents.size() != joint_count || !all_known)
    throw ShapeError(
        fmt::format("the skeleton of a report has {} parents, not one for each of {} "
                    "joints",
                    take.parents.size(), joint_count));
}

Json record(const ReportTake& take) {
  const ReportFigures all = figures(take);
  const std::vector<Joint> parts = joints(take.noisy);
  require_parents(take, parts.size());
  Json result = {{"frames", take.noisy.frames()},
                 {"rate", take.noisy.frame_rate},
                 {"unit", take.noisy.unit},
                 {"parents", take.parents},
                 {"verdict", verdict(take, all)},
                 {"figures", record(all)},
                 {"corrections", record(quantise(joint_corrections(take.outliers)))},
                 {"marks", marks(corrected_entries(take, all.threshold))}};
  for (const Joint& joint : parts)
    result["joints"].push_back(
        {{"name", joint.name}, {"first", joint.first_column}, {"columns", joint.columns}});
  result["clips"]["noisy"] = record(quantise(take.noisy.samples));
  result["clips"]["clean"] = record(quantise(take.clean.samples));
  if (take.truth) result["clips"]["truth"] = record(quantise(take.truth->samples));
  result["sigma"] = take.sigma ? record(quantise(*take.sigma)) : Json(nullptr);
  result["segments"] = Json::array();
  for (const DenoisedSegment& segment : take.segments)
    result["segments"].push_back(record(segment));
  return result;
}

Json record(const ReportTable& table) {
  Json result = {{"title", table.title},
                 {"note", table.note},
                 {"columns", table.columns},
                 {"rows", Json::array()}};
  for (const auto& row : table.rows) {
    if (row.size() != table.columns.size())
      throw ShapeError(fmt::format("table '{}' of a report has {} columns and a row of {}",
                                   table.title, table.columns.size(), row.size()));
    Json cells = Json::array();
    for (const ReportTable::Cell& cell : row)
      std::visit([&](const auto& value) { cells.push_back(value); }, cell);
    result["rows"].push_back(std::move(cells));
  }
  return result;
}

// JSON that can stand in a <script>: nothing in it ends the element or begins a comment. Bytes that
// are no UTF-8 are replaced.
std::string script_text(const Json& json) {
  const std::string text = json.dump(-1, ' ', true, Json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char letter : text) {
    if (letter == '<')
      safe += "\\u003c";
    else
      safe += letter;
  }
  return safe;
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char letter : text) switch (letter) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += letter;
    }
  return result;
}

struct Part {
  std::string_view name;
  std::string_view text;
};

// Replaces each {{name}} of the page, from its beginning to its end; what is put in is not read.
std::string filled(std::string_view page, std::initializer_list<Part> parts) {
  std::string result;
  std::size_t size = page.size();
  for (const Part& part : parts) size += part.text.size();
  result.reserve(size);
  while (!page.empty()) {
    const std::size_t open = std::min(page.find("{{"), page.size());
    result += page.substr(0, open);
    page.remove_prefix(open);
    if (page.empty()) break;
    const std::size_t close = page.find("}}");
    const std::string_view name = page.substr(2, close - 2);
    const auto part = std::ranges::find(parts, name, &Part::name);
    result += part->text;
    page.remove_prefix(close + 2);
  }
  return result;
}

}  // namespace

bool report_available() {
  return !report_asset::three.empty() && !report_asset::orbit_controls.empty() &&
         !report_asset::dygraph.empty() && !report_asset::dygraph_style.empty();
}

void require_report() {
  if (!report_available())
    throw Error(
        "this moclean was built without reports: install libjs-three and libjs-dygraphs "
        "(scripts/setup demo does) and build it again");
}

std::string html(const Report& report) {
  require_report();
  Json data = {{"title", report.title},
               {"take", report.take ? record(*report.take) : Json(nullptr)},
               {"tables", Json::array()},
               {"parameters", Json::array()}};
  for (const ReportTable& table : report.tables) data["tables"].push_back(record(table));
  for (const auto& [name, value] : report.parameters) data["parameters"].push_back({name, value});
  return filled(report_asset::page, {{"title", escaped(report.title)},
                                     {"licenses", report_asset::licenses},
                                     {"dygraph_style", report_asset::dygraph_style},
                                     {"style", report_asset::style},
                                     {"data", script_text(data)},
                                     {"three", report_asset::three},
                                     {"orbit_controls", report_asset::orbit_controls},
                                     {"dygraph", report_asset::dygraph},
                                     {"script", report_asset::script}});
}

}  // namespace moclean
