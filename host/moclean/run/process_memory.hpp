#pragma once

#include <cstdint>

namespace moclean {

/// Bytes of memory the machine has.
std::uint64_t physical_memory();

/// A quarter of it: what a run may take where nobody says otherwise.
std::uint64_t default_memory_limit();

/// Most bytes of memory this process has had so far (resident set).
std::uint64_t peak_memory();

/// From now on blocks of 128 KiB and more go back to the system as soon as they are freed.
///
/// glibc starts like that, but raises the size to 32 MiB as a program frees larger blocks, and
/// keeps what its threads have freed: 128 takes then peak at twice the memory of 8. It costs a page
/// fault per page of every block, some 5 % of a short run. Does nothing with another C library.
void return_freed_memory();

}  // namespace moclean
