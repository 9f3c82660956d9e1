#include "moclean/methods/matrix_normal/opencl_conjugate_gradients.hpp"

#include <algorithm>
#include <utility>

#include "moclean/device/kernel_source.hpp"
#include "moclean/linalg/work_group.hpp"

namespace moclean::opencl {
namespace {

constexpr Index chunk_rows = 32;  // with R's columns of a tile they fill a first-level cache

Defines tile_defines(const Device& device, const Tuning& tuning) {
  Defines defines = product_defines(device, NumberType::float64, tuning);
  defines["CHUNK"] = std::to_string(chunk_rows);
  return defines;
}

}  // namespace

// What no launch writes stays defined: padding, and the entries of segments not active.
ConjugateGradientsMemory::ConjugateGradientsMemory(MemoryLayout& of, KernelForm form,
                                                   int vector_width)
    : D(of.stacked()),
      W(of.stacked(Initially::zero)),
      S(of.stacked(Initially::zero)),
      r(of.stacked(Initially::zero)),
      z(of.stacked(Initially::zero)),
      p(of.stacked(Initially::zero)),
      p_before(of.stacked(Initially::zero)),
      product(of.stacked(Initially::zero)),
      inverse_pivot(of.stacked()),
      first_band(of.stacked()),
      R(of.square(Initially::zero)),
      precisions(of.per_row()),
      stiffness(of.vector()),
      least(of.per_segment()),
      rz(of.per_vector_of_columns(vector_width)),
      rz_before(of.per_vector_of_columns(vector_width)),
      bz(of.per_vector_of_columns(vector_width)),
      partial_pq(of.per_block()),
      curvatures(form == KernelForm::gpu ? of.stacked() : of.chunks(chunk_rows)),
      iterations(of.per_segment<std::int32_t>(Initially::zero)) {}

ConjugateGradients::InTiles::InTiles(const Device& device, const Tuning& tuning)
    : program(device, kernel_source::search_direction, tile_defines(device, tuning)),
      direction(program, "direction") {}

ConjugateGradients::InGroups::InGroups(const Device& device, int work_group)
    : program(device, kernel_source::search_direction_group, group_defines(device, work_group)),
      differences(program, "differences"),
      complete(program, "complete") {}

std::size_t ConjugateGradients::InGroups::largest_group() const {
  return std::min(differences.largest_group(), complete.largest_group());
}

ConjugateGradients::ConjugateGradients(const Device& device, const Tuning& tuning)
    : device_(device),
      program_(device, kernel_source::conjugate_gradients, common_defines(device)),
      factor_(program_, "factor"),
      start_(program_, "start"),
      update_(program_, "update") {
  if (tuning.form == KernelForm::gpu)
    work_group_ = fit_work_group(groups_, device, tuning.work_group);
  else
    tiles_.emplace(device, tuning);
}

ConjugateGradients::Memory ConjugateGradients::memory(MemoryLayout& of) const {
  return {of, groups_ ? KernelForm::gpu : KernelForm::cpu, vector_width(device_)};
}

void ConjugateGradients::operator()(const Batch& batch, Memory& m, Products<double>& products,
                                    int most_iterations, double tolerance) {
  const Grid columns = per_column(batch, device_, NumberType::float64);
  const auto search = [&](const Buffer<double>& z, double until, bool begins) {
    if (groups_)
      search_in_groups(batch, m, products, z, until, begins);
    else
      search_in_tiles(batch, m, z, until, begins);
  };
  factor_(columns, batch.device_segments(), batch.device_active(), m.W, m.precisions, m.stiffness,
          m.least, m.inverse_pivot, m.first_band);
  search(m.S, -1, true);
  start_(columns, batch.device_segments(), batch.device_active(), m.D, m.W, m.precisions,
         m.stiffness, m.inverse_pivot, m.first_band, m.product, m.r, m.z, m.rz, m.bz);
  for (int i = 0; i < most_iterations; ++i) {
    search(m.z, tolerance, i == 0);
    update_(columns, batch.device_segments(), batch.device_active(), m.precisions, m.stiffness,
            m.inverse_pivot, m.first_band, m.p, m.product, m.partial_pq, m.rz, m.bz,
            cl_double{tolerance}, m.S, m.r, m.z, m.rz_before);
    std::swap(m.rz, m.rz_before);
    std::swap(m.p, m.p_before);
  }
}

void ConjugateGradients::search_in_tiles(const Batch& batch, Memory& m, const Buffer<double>& z,
                                         double tolerance, bool begins) {
  tiles_->direction(per_block(batch), batch.device_segments(), batch.device_blocks(),
                    batch.active_blocks(), m.W, m.R, m.precisions, z, m.p_before, m.rz, m.rz_before,
                    m.bz, cl_double{tolerance}, cl_int{begins}, m.curvatures, m.p, m.product,
                    m.partial_pq, m.iterations);
}

// The product is also that of segments which are left as they are; nothing reads theirs.
void ConjugateGradients::search_in_groups(const Batch& batch, Memory& m, Products<double>& products,
                                          const Buffer<double>& z, double tolerance, bool begins) {
  const Grid grid = group_per_block(batch, work_group_);
  groups_->differences(grid, batch.device_segments(), batch.device_blocks(), batch.active_blocks(),
                       z, m.p_before, m.precisions, m.rz, m.rz_before, m.bz, cl_double{tolerance},
                       cl_int{begins}, m.p, m.curvatures, m.iterations);
  products.apply(batch, m.curvatures, m.R, m.product);
  groups_->complete(grid, batch.device_segments(), batch.device_blocks(), batch.active_blocks(),
                    m.W, m.p, m.product, m.partial_pq);
}

}  // namespace moclean::opencl
