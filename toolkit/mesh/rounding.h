#pragma once

/// Results that rounding does not decide.
namespace mimetra {

/// Numbers that differ by less than this share of themselves tie: rounding, which turning a mesh or
/// another order of its vertices changes, would decide between them.
constexpr double kNearTie = 1e-9;

/// Makes Eigen cut products of matrices into the same blocks on every processor.
///
/// Eigen takes the size of blocks from the caches that the processor reports, and the size decides
/// in which order numbers are added: the last bits of a product would differ from one machine to
/// another. This gives Eigen one size for all machines (`Eigen::setCpuCacheSizes`), in the program
/// or shared library that this code is linked into: once when that is loaded, and again where the
/// program has set another size since. Its own products are cut alike. Functions of mimetra whose
/// results hold such products call it first. Several threads may call it, and multiply, at a time;
/// but after the program has set other sizes the first call must be alone.
void fix_product_blocking();

}  // namespace mimetra
