#include "toolkit/mesh/rounding.h"

#include <Eigen/Core>

namespace mimetra {

namespace {

/// Smallest caches of processors with AVX2, so that blocks fit everywhere.
constexpr std::ptrdiff_t kFirstLevel = 32 * 1024;
constexpr std::ptrdiff_t kSecondLevel = 256 * 1024;
constexpr std::ptrdiff_t kThirdLevel = 2 * 1024 * 1024;

/// Sets the sizes before threads exist; later calls then only read them.
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
