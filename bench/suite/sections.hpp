#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "moclean/device/device.hpp"

namespace moclean::bench {

/// What the sections share.
struct Settings {
  std::filesystem::path data;  ///< collection of takes; may be empty or missing
  std::filesystem::path self;  ///< this program, for the sections that start it anew
  int repetitions = 7;
  int threads = 2;     ///< of the peers
  bool quick = false;  ///< fewer points on every axis
};

/// One part of the record, measured on its own.
struct Section {
  std::string name;
  nlohmann::json (*measure)(const Settings&, const Device&);
};

/// Every section, in the order of the tables:
///   limits        FMA and memory rates of the machine
///   takes         real takes by segment length, every contestant
///   segments frames columns   scaling on synthetic motion, one axis at a time
///   batch_size    cost of a segment in batches of up to 4096, the sizes in turn
///   products precision        choices of the OpenCL backend
///   kernels       time and work of every kernel
///   eigensolver   the batched symmetric eigenproblem alone
///   threads start_up memory   what takes processes of their own
const std::vector<Section>& sections();

/// Which device is measured: $MOCLEAN_DEVICE, else the best.
std::string device_selection();

/// What a process of its own measures and prints as JSON:
///   threads N DATA   one timed solve each of moclean and the peers, N threads
///   start_up         opening the device, building the kernels, first and second solve
///   memory N LIMIT   peak memory of solving N segments with a memory limit of LIMIT bytes
/// Throws ArgumentError for anything else.
nlohmann::json probe(const std::vector<std::string>& arguments);

// The sections' functions; each has the file of its name.
nlohmann::json measure_limits(const Settings& settings, const Device& device);
nlohmann::json measure_takes(const Settings& settings, const Device& device);
nlohmann::json measure_segments(const Settings& settings, const Device& device);
nlohmann::json measure_batch_size(const Settings& settings, const Device& device);
nlohmann::json measure_frames(const Settings& settings, const Device& device);
nlohmann::json measure_columns(const Settings& settings, const Device& device);
nlohmann::json measure_products(const Settings& settings, const Device& device);
nlohmann::json measure_precision(const Settings& settings, const Device& device);
nlohmann::json measure_kernels(const Settings& settings, const Device& device);
nlohmann::json measure_eigensolver(const Settings& settings, const Device& device);
nlohmann::json measure_threads(const Settings& settings, const Device& device);
nlohmann::json measure_start_up(const Settings& settings, const Device& device);
nlohmann::json measure_memory(const Settings& settings, const Device& device);

}  // namespace moclean::bench
