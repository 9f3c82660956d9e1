// Runs a job of two small takes, constant but for one gross error, in the folder that is given, and
// a third that is no recording; exits 0 if both are cleaned and the third is told of.

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <moclean/backend/opencl_backend.hpp>
#include <moclean/backend/reference_backend.hpp>
#include <moclean/formats/read_write.hpp>
#include <moclean/run/engine.hpp>

namespace {

moclean::Recording take() {
  moclean::Recording clip{
      moclean::Matrix::Constant(20, 6, 3), moclean::default_column_names(6), 0, {}};
  clip.samples(7, 2) += 50;
  return clip;
}

bool is_clean(const std::filesystem::path& file) {
  return std::abs(moclean::read_recording(file).samples(7, 2) - 3) < 1e-4;
}

}  // namespace

int main(int, char** arguments) {
  const std::filesystem::path folder = arguments[1];
  std::filesystem::create_directories(folder);
  for (const char* name : {"1.csv", "3.csv"}) moclean::write_recording(folder / name, take());
  std::ofstream(folder / "2.csv") << "a,b\n1,2\n3,x\n";

  moclean::Job job{.files = moclean::expand_folders({folder}),
                   .chain = moclean::parse_chain("rpca")};
  job.outputs = moclean::plan_outputs(
      {.inputs = {folder}, .files = job.files, .output = folder / "clean", .format = "csv"});
  job.on_failure = moclean::FailurePolicy::each_on_its_own;
  int written = 0;
  const auto count = [&](const moclean::RunEvent& event) {
    written += std::holds_alternative<moclean::TakeWritten>(event);
  };
  moclean::ReferenceBackend backend;
  const moclean::RunReport report = moclean::run_job(job, backend, count);

  for (const moclean::TakeReport& one : report.takes)
    std::printf("%s: %s\n", one.file.c_str(),
                one.failure.empty() ? "cleaned" : one.failure.c_str());
  const bool told = !report.takes[1].failure.empty();
  return written == 2 && told && is_clean(folder / "clean/1.csv") &&
                 is_clean(folder / "clean/3.csv")
             ? 0
             : 1;
}
