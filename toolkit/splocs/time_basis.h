#pragma once

#include <optional>

#include "toolkit/mesh/context.h"
#include "toolkit/splocs/vertex_blocks.h"

namespace mimetra {

/// Motion in a basis of few poses: X ~ Q B. Products with X then need only B.
struct TimeBasis {
  Eigen::MatrixXd Q;       ///< F x R, orthonormal columns
  VertexBlocks<double> B;  ///< Q^T X, R x 3n
};

/// Smallest tolerance that the sums, which cancel, can distinguish from zero.
constexpr double kLeastBasisTolerance = 1e-6;

/// Basis with ||X - Q B||_F <= tolerance ||X||_F, found by random projections with a fixed seed.
/// Returns nullopt if the basis needs more than half as many poses as X has frames, or a search
/// among more than `most` poses. A basis that is found does not depend on `most`. `norm2` is
/// ||X||_F^2. Throws Cancelled. \pre tolerance >= kLeastBasisTolerance
///
/// [Halko, Martinsson, Tropp. Finding Structure with Randomness. SIAM Review 53(2), 2011]
std::optional<TimeBasis> time_basis(const BlockSource<double>& X, double norm2, double tolerance,
                                    Eigen::Index most, const Context& = {});

}  // namespace mimetra
