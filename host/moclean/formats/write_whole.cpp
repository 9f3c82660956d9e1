#include "moclean/formats/write_whole.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>

#include <unistd.h>

namespace moclean {

int write_whole(int descriptor, std::string_view bytes) {
  constexpr std::size_t most = std::size_t{1} << 30;  // Linux writes less than 2 GiB at once
  while (!bytes.empty()) {
    const ssize_t some = ::write(descriptor, bytes.data(), std::min(bytes.size(), most));
    if (some >= 0)
      bytes.remove_prefix(static_cast<std::size_t>(some));
    else if (errno != EINTR)
      return errno;
  }
  return 0;
}

}  // namespace moclean
