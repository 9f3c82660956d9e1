// One call of OpenCL fails, or all from then on, with each error that the specification allows for
// it, while the library opens a device and solves a small take: it throws a DeviceError that names
// the call, or gives the bits of an undisturbed run; and works again when the device does.
//
// MOCLEAN_FAULTS=all tries every call and error; otherwise some, spread over the run.

#include <gmock/gmock.h>

#include "moclean/backend/opencl_backend.hpp"
#include "moclean/core/error.hpp"
#include "moclean/denoise/chain.hpp"

#include "cli/batch_folder.hpp"
#include "faults/fault_table.hpp"
#include "faults/opencl_fault_list.hpp"
#include "support/matrix.hpp"

namespace moclean::test {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

FaultTable table;

// What is tried now, for a process that is ended.
std::string current;

[[noreturn]] void end_with_the_fault() {
  fmt::print(stderr, "ended by {}\n", current);
  std::abort();
}

class LibraryFaults : public ::testing::TestWithParam<OpenClWork> {
 protected:
  static void TearDownTestSuite() { table.print("in the library"); }

  void SetUp() override {
    std::set_terminate(end_with_the_fault);
    set_opencl_faults("");
    if (list_devices().empty()) GTEST_SKIP() << "no OpenCL device";
    for (std::size_t i = 0; i < GetParam().options.size(); ++i) read_option(i);
  }

  void TearDown() override { set_opencl_faults(""); }

  void read_option(std::size_t i) {
    const auto& all = GetParam().options;
    const std::string& name = all[i];
    if (name == "--profile") profiling_ = Profiling::on;
    if (i + 1 == all.size()) return;
    if (name == "--method") method_ = all[i + 1];
    if (name == "--tolerance") defaults_.robust_pca.tolerance = std::stod(all[i + 1]);
    if (name == "--products") options_.products = parse_product_path(all[i + 1]);
    if (name == "--form") options_.form = parse_kernel_form(all[i + 1]);
    if (name == "--precision") options_.precision = Precision::mixed;
  }

  Denoised solved(OpenClBackend& backend, const Device& device) const {
    ChainDenoiser denoiser(parse_chain(method_, defaults_), &backend);
    Denoised result = std::move(denoiser.denoise({&take_, 1}).front());
    if (device.profile()) {
      EXPECT_FALSE(device.profile()->kernels().empty());
    }
    return result;
  }

  // With a device, programs and kernels of its own.
  Denoised from_the_start() const {
    const Device device({}, profiling_);
    OpenClBackend backend(device, options_);
    return solved(backend, device);
  }

  // Calls work() with every fault and compares what it gives.
  template <class Work>
  void expect_survival(const Matrix& expected, long most, const Work& work) {
    set_opencl_faults("");
    work();
    for (const auto& [function, calls] : opencl_calls()) {
      table[function].calls += calls;
      if (ends_clblast(function)) continue;
      for (const OpenClFaultCase& fault : faults_of(function, calls, most)) {
        SCOPED_TRACE(fault.text);
        try_one(fault, expected, work);
      }
      set_opencl_faults("");
      EXPECT_TRUE(same_bits(work(), expected)) << "after the faults of " << function;
    }
  }

  // CLBlast 1.5.3 releases what it could not allocate, and throws where nothing may be thrown: the
  // process ends, which only the program can be seen to survive.
  bool ends_clblast(const std::string& function) const {
    return options_.products == ProductPath::clblast &&
           (function == "any" || function == "clCreateBuffer" || function == "clReleaseMemObject");
  }

  template <class Work>
  void try_one(const OpenClFaultCase& fault, const Matrix& expected, const Work& work) {
    FaultTable::Row& row = table[fault.function];
    current = fault.text;
    set_opencl_faults(fault.text);
    ++row.injected;
    try {
      EXPECT_TRUE(same_bits(work(), expected)) << "a wrong result";
      ++row.harmless;
    } catch (const DeviceError& error) {
      ++row.told;
      EXPECT_THAT(error.what(), AnyOf(HasSubstr(named_in_messages(fault)), HasSubstr("CLBlast")));
    } catch (const std::exception& error) {
      ADD_FAILURE() << "not a DeviceError: " << error.what();
    }
    EXPECT_GT(opencl_faults_injected(), 0) << "the call never came";
  }

  Recording take_ = small_walk(8);
  std::string method_;
  StepDefaults defaults_;
  OpenClOptions options_;
  Profiling profiling_ = Profiling::off;
};

// Every such run compiles, or loads, all kernels anew: by default one work only.
TEST_P(LibraryFaults, WhileADeviceIsOpenedAndKernelsAreMadeAreTold) {
  if (!all_faults() && GetParam().name != "Tsvd") GTEST_SKIP() << "MOCLEAN_FAULTS=all tries it";
  const Matrix expected = from_the_start().motion;

  expect_survival(expected, all_faults() ? 40 : 1, [&] { return from_the_start().motion; });
}

TEST_P(LibraryFaults, WhileATakeIsSolvedAreToldAndForgotten) {
  const Device device({}, profiling_);
  OpenClBackend backend(device, options_);
  const Matrix expected = solved(backend, device).motion;

  expect_survival(expected, all_faults() ? 1'000'000 : 30,
                  [&] { return solved(backend, device).motion; });
}

class OpenClErrors : public ::testing::Test {
 protected:
  // What is said where these calls fail.
  static std::string error_with(const char* faults) {
    set_opencl_faults(faults);
    std::string error;
    try {
      const Device device;
      OpenClBackend(device).prepare(TruncatedSvd{});
    } catch (const DeviceError& caught) {
      error = caught.what();
    }
    set_opencl_faults("");
    return error;
  }

  void SetUp() override {
    if (list_devices().empty()) GTEST_SKIP() << "no OpenCL device";
  }
};

TEST_F(OpenClErrors, NoPlatformAndNoDeviceAreAnswers) {
  EXPECT_THAT(error_with("clGetPlatformIDs:1:-1001"), HasSubstr("no OpenCL device found"));
  EXPECT_THAT(error_with("clGetDeviceIDs:1+:-1"), HasSubstr("no OpenCL device found"));
}

TEST_F(OpenClErrors, OfAPlatformAreThoseOfItsDevices) {
  EXPECT_THAT(error_with("clGetDeviceIDs:1+:-5"),
              HasSubstr("to list the devices of platform 0: clGetDeviceIDs returned "
                        "CL_OUT_OF_RESOURCES"));
}

TEST_F(OpenClErrors, OfTheCompilerAreToldWithItsLogOrWhyThereIsNone) {
  EXPECT_THAT(error_with("clBuildProgram:1:-11"),
              ::testing::AllOf(HasSubstr("(clBuildProgram returned CL_BUILD_PROGRAM_FAILURE)"),
                               HasSubstr("-cl-std=CL1.2"), HasSubstr("(no log")));
  EXPECT_THAT(error_with("clBuildProgram:1:-11,clGetProgramBuildInfo:1+:-33"),
              HasSubstr("(no log: clGetProgramBuildInfo returned CL_INVALID_DEVICE)"));
}

// Once the kernels are made, the compiler is asked nothing more: a log of success is not needed.
TEST_F(OpenClErrors, OfALogNobodyReadsDoNotMatter) {
  EXPECT_EQ(error_with("clGetProgramBuildInfo:1+:-5"), "");
}

INSTANTIATE_TEST_SUITE_P(Of, LibraryFaults, ::testing::ValuesIn(opencl_works()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace moclean::test
