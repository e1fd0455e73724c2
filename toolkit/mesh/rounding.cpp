#include "toolkit/mesh/rounding.h"

#include <Eigen/Core>

namespace mimetra {

namespace {

/// The smallest caches of processors with AVX2: blocks that fit there fit everywhere.
constexpr std::ptrdiff_t kFirstLevel = 32 * 1024;
constexpr std::ptrdiff_t kSecondLevel = 256 * 1024;
constexpr std::ptrdiff_t kThirdLevel = 2 * 1024 * 1024;

/// Before there are threads, which from here on only read the sizes.
[[maybe_unused]] const bool kFixedWhenLoaded = (fix_product_blocking(), true);

}  // namespace

void fix_product_blocking() {
  if (Eigen::l1CacheSize() == kFirstLevel && Eigen::l2CacheSize() == kSecondLevel &&
      Eigen::l3CacheSize() == kThirdLevel) {
    return;
  }
  Eigen::setCpuCacheSizes(kFirstLevel, kSecondLevel, kThirdLevel);
}

}  // namespace mimetra
