#pragma once

/// Protection of results from rounding.
namespace mimetra {

/// Relative difference below which numbers tie. Otherwise rounding would decide, which changes when
/// a mesh is rotated or its vertices are renumbered.
constexpr double kNearTie = 1e-9;

/// Makes Eigen cut matrix products into the same blocks on every processor.
///
/// Eigen derives the block size from the processor's caches, and the block size decides the order
/// of additions. Without this call, the last bits of a product would differ between machines.
///
/// The function sets the cache sizes of Eigen (`Eigen::setCpuCacheSizes`) in the program or shared
/// library that links this code. This happens when it is loaded, and in each call after the program
/// has set other sizes. It also affects the program's own products.
///
/// Functions of mimetra whose results depend on such products call it first. Several threads may
/// call it, and multiply, at the same time. Only the first call after the program has set other
/// sizes must be alone.
void fix_product_blocking();

}  // namespace mimetra
