#include <functional>
#include <limits>

#include <gmock/gmock.h>

#include "tests/splocs/synthetic.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/splocs/decomposition.h"

namespace mimetra::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Decomposes a small sequence with the default options changed by `change`.
auto with(const std::function<void(DecompositionOptions&)>& change) {
  return [change] {
    const MeshSequence sequence = restless_grid(4, 3, 5);
    DecompositionOptions options = grid_options(sequence, 2);
    change(options);
    decompose(sequence, options);
  };
}

TEST(DecompositionOptions, RefuseValuesOutOfRange) {
  const auto refused = [](const char* message) {
    return ThrowsMessage<std::invalid_argument>(HasSubstr(message));
  };
  EXPECT_THAT(with([](auto& o) { o.count = 0; }), refused("count is 0"));
  EXPECT_THAT(with([](auto& o) { o.sparsity = -1; }), refused("sparsity is -1"));
  EXPECT_THAT(with([](auto& o) { o.rho = 0; }), refused("rho is 0"));
  EXPECT_THAT(with([](auto& o) { o.iterations = 0; }), refused("iterations is 0"));
  EXPECT_THAT(with([](auto& o) { o.admm_iterations = 0; }), refused("admm_iterations is 0"));
  EXPECT_THAT(with([](auto& o) { o.tolerance = -1; }), refused("tolerance is -1"));
  // Rounding hides such a compression.
  EXPECT_THAT(with([](auto& o) { o.basis_tolerance = 1e-9; }), refused("from 1e-6"));
  EXPECT_THAT(with([](auto& o) { o.basis_tolerance = 1; }),
              refused("basis_tolerance is 1; it must be from 0 to 0.5"));
}

TEST(DecompositionOptions, TakeAsManyComponentsAsCoordinates) {
  EXPECT_NO_THROW(with([](auto& o) { o.count = 36; })());
  EXPECT_THAT(with([](auto& o) { o.count = 37; }),
              ThrowsMessage<MismatchError>(
                  HasSubstr("37 components of a mesh of 12 vertices; at most 36")));
}

TEST(DecompositionOptions, RefuseLengthsInTheWrongOrder) {
  EXPECT_THAT(with([](auto& o) { o.d_min = o.d_max = 2; }),
              ThrowsMessage<std::invalid_argument>(HasSubstr("d_min is 2")));
  EXPECT_THAT(with([](auto& o) { o.d_min = -1; }),
              ThrowsMessage<std::invalid_argument>(HasSubstr("d_min is -1")));
}

TEST(DecompositionOptions, RefuseDistancesOfAnotherMesh) {
  EXPECT_THAT(with([](auto& o) {
                o.distances = [](std::span<const VertexIndex>) { return Eigen::MatrixXd(7, 1); };
              }),
              ThrowsMessage<std::invalid_argument>(HasSubstr("of 12 vertices: 7 x 1 values")));
}

TEST(DecompositionInput, RefusesOneFrame) {
  const MeshSequence sequence = restless_grid(4, 3, 5).slice(0, 1);
  EXPECT_THAT([&] { decompose(sequence, grid_options(sequence, 1)); },
              ThrowsMessage<MismatchError>(HasSubstr("one frame")));
}

/// A grid of which vertex 7 moves: in frame f by `weights`[f] of its diameter.
MeshSequence twitching(const Eigen::VectorXd& weights) {
  const Shape shape = grid(4, 3);
  Frames field = Frames::Zero(1, shape.positions.size());
  field(0, 3 * 7 + 2) = diameter(shape.positions);
  return synthesised(shape, weights, field);
}

MeshSequence twitching(double share) {
  return twitching(Eigen::Vector3d(0, share, 0));
}

auto decomposing(const MeshSequence& sequence) {
  return [sequence] { return decompose(sequence, grid_options(sequence, 1)); };
}

TEST(DecompositionInput, RefusesASequenceThatDoesNotMove) {
  EXPECT_THAT(decomposing(twitching(0)),
              ThrowsMessage<MismatchError>(HasSubstr("nothing moves: all 3 frames are the rest "
                                                     "pose; expected motion above 1e-06 of its "
                                                     "diameter")));
}

TEST(DecompositionInput, RefusesRoundingNoiseAndSaysHowLargeItIs) {
  EXPECT_THAT(decomposing(twitching(1e-9)),
              ThrowsMessage<MismatchError>(AllOf(
                  HasSubstr("nothing moves: all 3 frames are the rest pose to 3.606e-09, 1e-09 "
                            "of its diameter"),
                  HasSubstr("give frames that deform"))));
}

TEST(DecompositionInput, IsRefusedUpToTheLeastMotion) {
  EXPECT_THROW(decomposing(twitching(0.99 * kLeastMotion))(), MismatchError);
  EXPECT_EQ(decomposing(twitching(1.01 * kLeastMotion))().centers, std::vector<VertexIndex>{7});
}

TEST(DecompositionInput, MovesWhereItsFramesAreEqualAndNotTheRestPose) {
  EXPECT_NO_THROW(decomposing(twitching(Eigen::Vector2d(1e-5, 1e-5)))());
}

TEST(DecompositionInput, WithoutExtentMovesByAnyAmount) {
  Frames frames = Frames::Zero(2, 6);
  const MeshSequence still(Connectivity::from_triangles(2, Triangles(0, 3)), frames);
  EXPECT_THROW(decomposing(still)(), MismatchError);
  frames(1, 4) = 1e-9;
  EXPECT_NO_THROW(decomposing(still.with_frames(frames))());
}

TEST(DecompositionOptions, AreKeptWithoutTheCallersFunctions) {
  const MeshSequence sequence = restless_grid(4, 3, 5);
  const Components components = decompose(sequence, grid_options(sequence, 2));
  EXPECT_EQ(components.options.count, 2);
  EXPECT_FALSE(components.options.distances);
}

}  // namespace
}  // namespace mimetra::test
