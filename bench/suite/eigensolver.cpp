// The batched symmetric eigenproblem alone, on Gram matrices of a real take, in matrices/s.
#include <atomic>
#include <thread>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/linalg/eigen.hpp"

#include "peers/segment_solver.hpp"
#include "suite/sections.hpp"
#include "suite/statistics.hpp"
#include "suite/takes.hpp"

namespace moclean::bench {
namespace {

/// Eigenpairs of stacked n x n matrices: row k of block b of `vectors` belongs to values(b, k).
struct Eigenpairs {
  Matrix vectors, values;
};

/// A way to solve all of them. Only solve() is timed.
class Competitor {
 public:
  virtual ~Competitor() = default;
  virtual void prepare() = 0;
  virtual void solve() = 0;
  virtual Eigenpairs result() = 0;
};

/// moclean's solver; the matrices are on the device before the clock starts.
class OnDevice final : public Competitor {
 public:
  OnDevice(const Device& device, const SegmentBatch& grams)
      : device_(device),
        grams_(grams),
        batch_(device, grams, 0, grams.segments()),
        solver_(device),
        a_(device, batch_.square_size()),
        z_(device, batch_.square_size()),
        values_(device, batch_.vector_size()) {}

  void prepare() override {
    a_.write(grams_.storage());
    device_.finish();
  }
  void solve() override {
    solver_(batch_, a_, z_, values_);
    device_.finish();
  }
  Eigenpairs result() override {
    solver_.check(batch_);
    Eigenpairs padded{Matrix(grams_.rows(), grams_.pitch()),
                      Matrix(grams_.segments(), grams_.pitch())};
    z_.read({padded.vectors.data(), batch_.square_size()});
    values_.read({padded.values.data(), batch_.vector_size()});
    return {padded.vectors.leftCols(grams_.columns()), padded.values.leftCols(grams_.columns())};
  }

 private:
  const Device& device_;
  const SegmentBatch& grams_;
  Batch batch_;
  SymmetricEigen solver_;
  Buffer<double> a_, z_, values_;
};

/// A peer; every thread takes the next matrix when it is done with one.
class OnThreads final : public Competitor {
 public:
  template <class Make>
  OnThreads(int threads, const Make& make, const SegmentBatch& grams) : grams_(grams) {
    for (int t = 0; t < threads; ++t) solvers_.push_back(make());
  }

  void prepare() override {
    pairs_ = {grams_.block(0, grams_.rows()), Matrix(grams_.segments(), grams_.columns())};
  }
  void solve() override {
    const int n = static_cast<int>(grams_.columns());
    std::atomic<Index> next = 0;
    std::vector<std::jthread> workers;
    for (const auto& solver : solvers_)
      workers.emplace_back([&, &peer = *solver] {
        for (Index b = next++; b < grams_.segments(); b = next++)
          peer.solve(n, &pairs_.vectors(grams_.first_row(b), 0), &pairs_.values(b, 0));
      });
  }
  Eigenpairs result() override { return pairs_; }

 private:
  const SegmentBatch& grams_;
  std::vector<std::unique_ptr<peers::Eigensolver>> solvers_;
  Eigenpairs pairs_;
};

/// D'D of runs of 200 frames that overlap by half.
SegmentBatch gram_matrices(const Matrix& samples, Index count) {
  constexpr Index run = 200;
  std::vector<Index> first_row;
  for (Index b = 0; b <= count; ++b) first_row.push_back(b * samples.cols());
  SegmentBatch grams(samples.cols(), std::move(first_row));
  for (Index b = 0; b < count; ++b) {
    const auto D = samples.middleRows(b * run / 2 % (samples.rows() - run), run);
    grams.segment(b) = D.transpose() * D;
  }
  return grams;
}

/// Throws unless |ZG - Lambda Z| <= 1e-12 |G| for every matrix.
void check(const std::string& name, const Eigenpairs& pairs, const SegmentBatch& grams) {
  for (Index b = 0; b < grams.segments(); ++b) {
    const auto G = grams.segment(b);
    const auto Z = pairs.vectors.middleRows(grams.first_row(b), grams.columns());
    const double residual = (Z * G - pairs.values.row(b).asDiagonal() * Z).norm() / G.norm();
    if (!(residual <= 1e-12))
      throw Error(fmt::format("{}: residual {:.1e} for matrix {}", name, residual, b));
  }
}

}  // namespace

nlohmann::json measure_eigensolver(const Settings& settings, const Device& device) {
  const NoisyTake take = noisy_takes(settings.data).front();
  const SegmentBatch grams = gram_matrices(take.samples, settings.quick ? 64 : 256);
  const int threads = settings.threads;
  OnDevice ours(device, grams);
  OnThreads lapack(threads, peers::make_lapack_eigensolver, grams);
  OnThreads eigen(threads, peers::make_eigen_eigensolver, grams);
  const std::vector<std::pair<std::string, Competitor*>> competitors = {
      {"opencl", &ours}, {"dsyevd", &lapack}, {"SelfAdjointEigenSolver", &eigen}};

  std::vector<std::vector<double>> seconds(competitors.size()), ratios(competitors.size());
  for (int repetition = -1; repetition < settings.repetitions; ++repetition)
    for (std::size_t c = 0; c < competitors.size(); ++c) {
      const auto& [name, competitor] = competitors[c];
      competitor->prepare();
      const double taken = seconds_of([&] { competitor->solve(); });
      if (repetition < 0) {  // the first is for the check
        check(name, competitor->result(), grams);
        continue;
      }
      seconds[c].push_back(taken);
      ratios[c].push_back(taken / seconds[0].back());
    }

  nlohmann::json record = {{"matrices", grams.segments()}, {"order", grams.columns()}};
  for (std::size_t c = 0; c < competitors.size(); ++c)
    record["contestants"].push_back(
        {{"name", competitors[c].first},
         {"seconds", summary(seconds[c])},
         {"ratio", summary(ratios[c])},
         {"matrices_per_second", static_cast<double>(grams.segments()) / median(seconds[c])}});
  return record;
}

}  // namespace moclean::bench
