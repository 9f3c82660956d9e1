#include "moclean/experiment/paper_tables.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace moclean {
namespace {

constexpr std::array sequences = {
    PaperSequence{.name = "Seq1",
                  .take = "14_46",
                  .frames = 1200,
                  .noisy_frames = 400,
                  .segment_length = 200,
                  .slra = 0.1031,
                  .tsvd = 0.2574,
                  .svt = 0.2673,
                  .rpca = 0.2768,
                  .lengths = {{{200, 0.1031}, {300, 0.1219}, {400, 0.1526}, {600, 0.2213}}}},
    PaperSequence{.name = "Seq2",
                  .take = "13_27",
                  .frames = 2000,
                  .noisy_frames = 700,
                  .segment_length = 400,
                  .slra = 0.1785,
                  .tsvd = 0.4578,
                  .svt = 0.4126,
                  .rpca = 0.3972,
                  .lengths = {{{200, 0.1127}, {400, 0.1785}, {500, 0.2556}, {1000, 0.3492}}}},
    PaperSequence{.name = "Seq3",
                  .take = "14_06",
                  .frames = 2800,
                  .noisy_frames = 900,
                  .segment_length = 400,
                  .slra = 0.2455,
                  .tsvd = 0.4623,
                  .svt = 0.4986,
                  .rpca = 0.5238,
                  .lengths = {{{200, 0.1026}, {400, 0.2456}, {700, 0.2519}, {1400, 0.3862}}}}};

// The place of a method among those of the experiment, which it joins if it is new.
std::size_t method_index(Experiment& experiment, const Chain& chain) {
  const auto found = std::ranges::find(experiment.methods, chain, &ExperimentMethod::chain);
  if (found != experiment.methods.end())
    return static_cast<std::size_t>(found - experiment.methods.begin());
  experiment.methods.push_back({chain.empty() ? "none" : to_string(chain), chain});
  return experiment.methods.size() - 1;
}

// Adds rows to the part of a take.
class Rows {
 public:
  Rows(Experiment& experiment, PaperPart& part, const RobustPca& robust_pca)
      : experiment_(experiment), part_(part), robust_pca_(robust_pca) {}

  void add(std::string label, const Chain& chain, std::optional<double> printed) {
    part_.rows.push_back({method_index(experiment_, chain), std::move(label), printed});
  }
  void add_noisy() { add("none (noisy)", {}, std::nullopt); }
  void add_slra(std::string label, Index length, std::optional<double> printed) {
    add(std::move(label), {LowRank{{.length = length}, robust_pca_}}, printed);
  }
  void add_rpca(std::string label, std::optional<double> printed) {
    add(std::move(label), {LowRank{{.whole = true}, robust_pca_}}, printed);
  }

 private:
  Experiment& experiment_;
  PaperPart& part_;
  const RobustPca& robust_pca_;
};

std::optional<double> printed(const PaperSequence* sequence, double PaperSequence::*value) {
  if (!sequence) return std::nullopt;
  return sequence->*value;
}

void add_methods(Rows& rows, const PaperSequence* sequence) {
  const Index length = sequence ? sequence->segment_length : 200;
  const Segmentation whole{.whole = true};
  rows.add_slra(fmt::format("slra, {} frames", length), length,
                printed(sequence, &PaperSequence::slra));
  rows.add("tsvd, rank 10", {LowRank{whole, TruncatedSvd{.rank = 10}}},
           printed(sequence, &PaperSequence::tsvd));
  rows.add("svt, threshold by the rule", {LowRank{whole, SingularValueThresholding{}}},
           printed(sequence, &PaperSequence::svt));
  rows.add_rpca("rpca", printed(sequence, &PaperSequence::rpca));
}

void add_lengths(Rows& rows, const PaperSequence* sequence, Index frames) {
  if (sequence)
    for (const auto& [length, fd] : sequence->lengths)
      rows.add_slra(fmt::format("{}", length), length, fd);
  else
    for (const Index length : {200, 400, 700, 1400})
      if (plan({.length = length}, frames).size() > 2)
        rows.add_slra(fmt::format("{}", length), length, std::nullopt);
  rows.add_rpca("whole (rpca)", printed(sequence, &PaperSequence::rpca));
}

}  // namespace

std::span<const PaperSequence> paper_sequences() { return sequences; }

const PaperSequence* find_sequence(std::string_view take_name) {
  const auto found = std::ranges::find(sequences, take_name, &PaperSequence::take);
  return found == sequences.end() ? nullptr : &*found;
}

PaperExperiment paper_experiment(PaperTable table, std::vector<ExperimentTake> takes,
                                 const std::vector<bool>& is_papers,
                                 std::vector<std::uint64_t> seeds, const RobustPca& defaults) {
  PaperExperiment result{
      .experiment = {.takes = std::move(takes), .noises = {}, .methods = {}, .seeds = seeds},
      .parts = {},
      .cells = {}};
  Experiment& experiment = result.experiment;
  for (std::size_t t = 0; t < experiment.takes.size(); ++t) {
    const ExperimentTake& take = experiment.takes[t];
    PaperPart part{.sequence = is_papers[t] ? find_sequence(take.name) : nullptr, .rows = {}};
    part.noisy_frames = part.sequence ? part.sequence->noisy_frames : take.clip.frames() / 3;
    const GaussianFrames noise{.frames = part.noisy_frames, .mean = 1, .sd = 1.2};
    experiment.noises.push_back({to_string(Noise(noise)), {noise}});
    Rows rows(experiment, part, defaults);
    rows.add_noisy();
    if (table == PaperTable::methods)
      add_methods(rows, part.sequence);
    else
      add_lengths(rows, part.sequence, take.clip.frames());
    for (const PaperRow& row : part.rows)
      for (std::size_t s = 0; s < seeds.size(); ++s)
        result.cells.push_back({t, t, row.method, s, seeds[s]});
    result.parts.push_back(std::move(part));
  }
  return result;
}

}  // namespace moclean
