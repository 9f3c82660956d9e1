#include "cli/options/backend_options.hpp"

#include <algorithm>
#include <thread>

#include <CLI/CLI.hpp>

#include "moclean/backend/opencl_backend.hpp"
#include "moclean/core/error.hpp"
#include "moclean/run/byte_size.hpp"
#include "moclean/run/process_memory.hpp"

#include "cli/options/checks.hpp"

namespace moclean::cli {
namespace {

constexpr int most_jobs = 4096;  // each stage starts so many threads

void add_device(CLI::App& command, BackendOptions& options) {
  command.add_option("--backend", options.backend, "OpenCL device, or the plain reference (Eigen)")
      ->check(one_of({"opencl", "reference"}))
      ->capture_default_str()
      ->type_name("BACKEND")
      ->group(backend_group);
  command
      .add_option("--device", options.device,
                  "OpenCL device: cpu, gpu, P:D (see moclean devices), or part of its name; "
                  "otherwise the best one")
      ->envname("MOCLEAN_DEVICE")
      ->type_name("SEL")
      ->group(backend_group);
}

// What `--products group`, as earlier versions said, leaves to complete_backend().
void take_products(const std::string& text, BackendOptions& options) {
  options.former_spelling = text == former_gpu_products;
  options.products = options.former_spelling ? ProductPath::own : parse_product_path(text);
}

void add_kernels(CLI::App& command, BackendOptions& options) {
  command
      .add_option_function<std::string>(
          "--form", [&](const std::string& text) { options.form = parse_kernel_form(text); },
          "Form of our kernels on the OpenCL device, whatever that is: for CPUs, or for GPUs; "
          "default: that of the tuning, else gpu on GPUs and cpu elsewhere")
      ->check(one_of({"cpu", "gpu"}))
      ->type_name("FORM")
      ->group(backend_group);
  command
      .add_option_function<std::string>(
          "--products", [&](const std::string& text) { take_products(text, options); },
          "Matrix products on the OpenCL device: of our kernels in that form, or of CLBlast; "
          "default: those of the tuning, else own")
      ->check(CLI::IsMember({"own", "clblast", "group"}).description("{own,clblast}"))
      ->type_name("PATH")
      ->group(backend_group);
}

void add_arithmetic(CLI::App& command, BackendOptions& options) {
  command
      .add_option_function<std::string>(
          "--precision",
          [&](const std::string& text) { options.precision = parse_precision(text); },
          "Double precision throughout, or single for the frames and double for the eigenproblems")
      ->check(one_of({"f64", "mixed"}))
      ->default_str("f64")
      ->type_name("PRECISION")
      ->group(backend_group);
  command
      .add_flag_callback(
          "--no-tuning", [&] { options.use_tuning = false; },
          "Do not use what moclean tune has found for the device")
      ->group(backend_group);
}

void add_resources(CLI::App& command, BackendOptions& options) {
  options.jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  command
      .add_option("--jobs", options.jobs,
                  "Threads for reading, for writing, and for the reference; default: all of the "
                  "machine")
      ->check(whole_number(1, most_jobs))
      ->type_name("N")
      ->group(backend_group);
  command
      .add_option_function<std::string>(
          "--memory-limit",
          [&](const std::string& text) {
            options.memory_limit = parse_byte_size("--memory-limit", text);
            options.limits_memory = true;
          },
          "Memory for recordings and for the batches of the device, which get a quarter of it: a "
          "number with K, M, G or T; default: a quarter of the machine's")
      ->type_name("SIZE")
      ->group(backend_group);
}

}  // namespace

void add_backend_options(CLI::App& command, BackendOptions& options) {
  add_device(command, options);
  add_kernels(command, options);
  add_arithmetic(command, options);
  add_resources(command, options);
}

void complete_backend(BackendOptions& options) {
  const bool mixed = options.precision == Precision::mixed;
  if (mixed && options.backend != "opencl")
    throw ArgumentError("--precision mixed needs --backend opencl; the reference is double");
  if (options.former_spelling && options.form == KernelForm::cpu)
    throw ArgumentError("--products group means --form gpu and contradicts --form cpu");
  if (options.former_spelling) options.form = KernelForm::gpu;
  if (mixed && options.form == KernelForm::gpu)
    throw ArgumentError("--precision mixed works with --form cpu only");
  if (mixed && options.products == ProductPath::clblast)
    throw ArgumentError("--precision mixed works with --products own only, not with clblast");
  if (options.memory_limit == 0) options.memory_limit = default_memory_limit();
}

}  // namespace moclean::cli
