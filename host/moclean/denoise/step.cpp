#include <array>

#include "moclean/core/error.hpp"
#include "moclean/denoise/chain.hpp"

namespace moclean {
namespace {

constexpr std::string_view slra = "slra", rpca = "rpca";

// What segments a method takes where nothing says: as measured best, or the take whole.
template <class M>
constexpr Segmentation default_segmentation = {.whole = true};
template <>
constexpr Segmentation default_segmentation<TemporalRobustPca> = {.length = 400};

// Where segments end.
enum class Division { equal, cheapest };
constexpr std::array<std::string_view, 2> divisions = {"equal", "auto"};

// The methods whose segments can be planned.
template <class M>
constexpr bool can_be_planned =
    std::is_same_v<M, RobustPca> || std::is_same_v<M, TemporalRobustPca>;

// A method's parameters and those of its segmentation, as one specification has them.
template <class M>
struct Segmented {
  M method = {};
  std::optional<Index> length = {};
  std::optional<Index> segments = {};
  std::optional<Index> overlap = {};
  Division division = Division::equal;

  static void visit(auto& self, auto& visitor) {
    M::visit(self.method, visitor);
    visitor("segment-length", self.length);
    visitor("segments", self.segments);
    visitor("overlap", self.overlap);
    if constexpr (can_be_planned<M>) visitor("segment", self.division, divisions);
  }

  Segmentation segmentation(const StepDefaults& defaults, const Segmentation& otherwise) const {
    Segmentation chosen = defaults.segmentation.value_or(otherwise);
    if (length) chosen = {.length = *length};
    if (segments) chosen = {.segments = *segments};
    if (chosen.whole && overlap.value_or(0) > 0)
      throw ArgumentError("overlap needs segment-length or segments");
    chosen.cheapest = !chosen.whole && division == Division::cheapest;
    if (!chosen.whole) chosen.overlap = overlap.value_or(defaults.overlap);
    return chosen;
  }
};

template <class M>
void check(const Segmented<M>& step) {
  check(step.method);
  if (step.length && step.segments)
    throw ArgumentError("segment-length and segments exclude each other");
  if ((step.length && *step.length < 1) || (step.segments && *step.segments < 1))
    throw ArgumentError("segment-length and segments are expected to be at least 1");
  if (step.overlap && *step.overlap < 0)
    throw ArgumentError("overlap is expected to be at least 0");
}

template <class M>
Step read_segmented(const Specification& given, const M& method, const StepDefaults& defaults,
                    const Segmentation& otherwise) {
  const bool automatic = can_be_planned<M> && defaults.automatic;
  const auto step = read_parameters<Segmented<M>>(
      given, {.method = method, .division = automatic ? Division::cheapest : Division::equal});
  return LowRank{step.segmentation(defaults, otherwise), step.method};
}

Step read_whole(const Specification& given, const RobustPca& method) {
  return LowRank{{.whole = true}, read_parameters<RobustPca>(given, method)};
}

// The matrix methods but robust PCA, which has two names.
using OtherMethods =
    std::variant<TruncatedSvd, SingularValueThresholding, MatrixCompletion, TemporalRobustPca>;

std::optional<Step> find_method(const Specification& given, const StepDefaults& defaults) {
  if (given.name() == slra)
    return read_segmented(given, defaults.robust_pca, defaults, Segmentation{});
  if (given.name() == rpca) return read_whole(given, defaults.robust_pca);
  std::optional<Step> found;
  find_alternative<OtherMethods>(given, [&]<class M>(const Specification&, const M& method) {
    found = read_segmented(given, method, defaults, default_segmentation<M>);
    return method;
  });
  return found;
}

Step parse_step(std::string_view text, const StepDefaults& defaults) {
  const Specification given("method", text);
  if (const auto method = find_method(given, defaults)) return *method;
  if (given.name() == Automatic::name) return read_parameters<Automatic>(given);
  const auto filter =
      find_alternative<Filter>(given, []<class F>(const Specification& own, const F& defaulted) {
        return read_parameters(own, defaulted);
      });
  if (!filter) given.throw_unknown(step_names());
  return *filter;
}

template <class M>
std::string method_name(const M& method, const Segmentation& segmentation) {
  if constexpr (std::is_same_v<M, RobustPca>)
    return std::string(segmentation.whole ? rpca : slra);
  else
    return std::string(method.name);
}

std::string specification_of(const LowRank& step) {
  return std::visit(
      [&]<class M>(const M& method) {
        const Segmentation& chosen = step.segmentation;
        detail::ParameterWriter writer(method_name(method, chosen));
        M::visit(method, writer);
        if (!chosen.whole && chosen.segments == 0) writer("segment-length", chosen.length);
        if (!chosen.whole && chosen.segments > 0) writer("segments", chosen.segments);
        if (chosen.overlap > 0) writer("overlap", chosen.overlap);
        if (chosen.cheapest) writer("segment", Division::cheapest, divisions);
        return writer.text();
      },
      step.method);
}

}  // namespace

std::vector<std::string_view> step_names() {
  std::vector<std::string_view> names = {Automatic::name, slra, rpca};
  for (const std::string_view name : names_of<OtherMethods>()) names.push_back(name);
  for (const std::string_view name : names_of<Filter>()) names.push_back(name);
  return names;
}

Chain parse_chain(std::string_view specification, const StepDefaults& defaults) {
  Chain chain;
  for (const std::string_view text : split_chain(specification))
    chain.push_back(parse_step(text, defaults));
  return chain;
}

std::string name_of(const Step& step) {
  if (const auto* filter = std::get_if<Filter>(&step)) return std::string(name_of(*filter));
  if (std::holds_alternative<Automatic>(step)) return std::string(Automatic::name);
  const auto& low_rank = std::get<LowRank>(step);
  return std::visit([&](const auto& m) { return method_name(m, low_rank.segmentation); },
                    low_rank.method);
}

std::string to_string(const Step& step) {
  if (const auto* filter = std::get_if<Filter>(&step)) return to_string(*filter);
  if (const auto* automatic = std::get_if<Automatic>(&step)) return to_specification(*automatic);
  return specification_of(std::get<LowRank>(step));
}

std::string to_string(const Chain& chain) {
  std::string text;
  for (const Step& step : chain) text += (text.empty() ? "" : "+") + to_string(step);
  return text;
}

const LowRank* first_low_rank(const Chain& chain) {
  for (const Step& step : chain)
    if (const auto* found = std::get_if<LowRank>(&step)) return found;
  return nullptr;
}

std::string needs_frame_rate(const Chain& chain) {
  for (const Step& step : chain)
    if (const auto* filter = std::get_if<Filter>(&step); filter && needs_frame_rate(*filter))
      return std::string(name_of(*filter));
  return {};
}

const Step* first_on_backend(const Chain& chain) {
  for (const Step& step : chain)
    if (!std::holds_alternative<Filter>(step)) return &step;
  return nullptr;
}

bool has_sigma(const Chain& chain) { return std::holds_alternative<Automatic>(chain.back()); }

bool accepts_missing(const Chain& chain) {
  for (const Step& step : chain) {
    if (const auto* method = std::get_if<LowRank>(&step)) return accepts_missing(method->method);
    const auto* filter = std::get_if<Filter>(&step);
    if (!filter || fills_gaps(*filter)) return true;
  }
  return true;
}

}  // namespace moclean
