#include <gmock/gmock.h>

#include "tests/cache_sizes.h"
#include "tests/splocs/synthetic.h"
#include "tests/streams.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/splocs/decomposition_plan.h"

/// Decompositions of motion that the memory allowed does not hold, against those that it does: the
/// same bytes.
namespace mimetra::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// 79 blocks of vertices in 64 runs: the motion is larger than all else.
const MeshSequence& long_take() {
  static const MeshSequence take = restless_grid(140, 108, 24);
  return take;
}

DecompositionPlan plan_of(const FrameSource& frames, const DecompositionOptions& options,
                          const Context& context = {}) {
  return planned_decomposition(frames, VertexPart(frames.vertices()), options, context);
}

double motion_bytes(const FrameSource& frames) {
  return 24.0 * frames.frames() * frames.vertices();
}

void expect_same_bytes(const Components& found, const Components& expected) {
  EXPECT_TRUE(equal_bytes(found.displacements, expected.displacements));
  EXPECT_TRUE(equal_bytes(found.weights, expected.weights));
  EXPECT_TRUE(equal_bytes(found.support, expected.support));
  EXPECT_EQ(found.energies, expected.energies);
  EXPECT_EQ(found.centers, expected.centers);
  EXPECT_EQ(found.scale, expected.scale);
}

class MemoryTest : public testing::Test {
 protected:
  MemoryTest() : sequence_(long_take()), options_(grid_options(sequence_, 4)) {
    options_.iterations = 4;
  }

  /// With as much memory as everything but the motion takes.
  Context within_less() const {
    DecompositionOptions without_basis = options_;
    without_basis.basis_tolerance = 0;
    const double all = plan_of(sequence_, without_basis, context_).bytes;
    return context_.with_memory(all - motion_bytes(sequence_) / 2);
  }

  /// Of frames in memory and of those that are read, whatever place the motion has.
  void expect_same_bytes_in(MotionPlace place) {
    const Components expected = decompose(sequence_, options_, context_);
    ASSERT_EQ(plan_of(sequence_, options_, context_).place, MotionPlace::memory);
    const Context bounded = within_less();
    ASSERT_EQ(plan_of(sequence_, options_, bounded).place, place);
    expect_same_bytes(decompose(sequence_, options_, bounded), expected);
    expect_same_bytes(decompose(*streamed(sequence_), options_, bounded), expected);
  }

  MeshSequence sequence_;
  DecompositionOptions options_;
  Context context_ = Context().with_threads(2);
};

TEST_F(MemoryTest, DoesNotChangeTheResult) {
  expect_same_bytes_in(MotionPlace::scratch);
}

TEST_F(MemoryTest, DoesNotChangeTheResultInSinglePrecision) {
  options_.precision = IterationPrecision::single_precision;
  expect_same_bytes_in(MotionPlace::scratch);
}

TEST_F(MemoryTest, DoesNotChangeTheResultInABasisOfTime) {
  sequence_ = restless_grid(70, 54, 100);
  options_ = grid_options(sequence_, 4);
  options_.iterations = 4;
  options_.basis_tolerance = 0.3;
  const Components expected = decompose(sequence_, options_);
  const Context bounded =
      Context().with_memory(plan_of(sequence_, options_).bytes - 0.05 * motion_bytes(sequence_));
  ASSERT_EQ(plan_of(sequence_, options_, bounded).place, MotionPlace::scratch);
  expect_same_bytes(decompose(sequence_, options_, bounded), expected);
  expect_same_bytes(decompose(*streamed(sequence_), options_, bounded), expected);
  // It is one in a basis.
  options_ = grid_options(sequence_, 4);
  options_.iterations = 4;
  EXPECT_FALSE(equal_bytes(decompose(sequence_, options_).weights, expected.weights));
}

TEST_F(MemoryTest, IsRefusedWhereItDoesNotHoldABasisOfTime) {
  options_.basis_tolerance = 0.3;
  DecompositionOptions short_one = options_;
  short_one.iterations = 1;
  ASSERT_NO_THROW(decompose(sequence_, short_one, context_));
  const Context bounded = within_less();
  ASSERT_LT(plan_of(sequence_, options_, bounded).poses, 12);
  EXPECT_THAT([&] { decompose(sequence_, options_, bounded); },
              ThrowsMessage<MismatchError>(HasSubstr("option 'basis-tolerance': ")));
}

TEST_F(MemoryTest, DoesNotChangeTheResultWhereTheSequenceIsReadAgain) {
  // A pass for the component of the start, and one for the iteration: a file would not pay.
  options_.count = 1;
  options_.iterations = 1;
  expect_same_bytes_in(MotionPlace::sequence);
  // Of a stream no vertices can be read.
  EXPECT_EQ(plan_of(*streamed(sequence_), options_, within_less()).place, MotionPlace::scratch);
}

TEST_F(MemoryTest, DoesNotChangeTheError) {
  DecompositionOptions short_one = options_;
  short_one.iterations = 1;
  const Components components = decompose(sequence_, short_one, context_);
  const DecompositionError expected = decomposition_error(sequence_, components, context_);
  const DecompositionError found =
      decomposition_error(*streamed(sequence_), components, within_less());
  EXPECT_EQ(found.rms, expected.rms);
  EXPECT_EQ(found.kg, expected.kg);
  EXPECT_EQ(found.sparsity, expected.sparsity);
}

TEST_F(MemoryTest, IsNeverMoreThanAllowed) {
  for (const double less : {0.0, 0.2, 0.7, 1.0}) {
    const double allowed =
        plan_of(sequence_, options_, context_).bytes - less * motion_bytes(sequence_);
    const DecompositionPlan plan = plan_of(sequence_, options_, context_.with_memory(allowed));
    EXPECT_LE(plan.bytes, allowed);
    EXPECT_EQ(plan.scratch_bytes, plan.place == MotionPlace::scratch ? motion_bytes(sequence_) : 0);
  }
}

TEST_F(MemoryTest, CountsThePosesOfABasisOfTime) {
  sequence_ = restless_grid(70, 54, 100);
  options_ = grid_options(sequence_, 4);
  const double without = plan_of(sequence_, options_).bytes;
  options_.basis_tolerance = 0.3;
  const DecompositionPlan all = plan_of(sequence_, options_);
  EXPECT_EQ(all.poses, 50);
  // Each is at least a course over time and a shape, twice.
  EXPECT_GE(all.bytes, without + 50 * 16.0 * (100 + 3 * sequence_.vertices()));
  for (const double share : {0.2, 0.6, 0.9, 1.0}) {
    const double allowed = without + share * (all.bytes - without);
    const DecompositionPlan plan = plan_of(sequence_, options_, Context().with_memory(allowed));
    EXPECT_LE(plan.bytes, allowed);
    EXPECT_GT(plan.poses, 0);
  }
}

TEST_F(MemoryTest, HoldsFewerThreadsWhereThereIsLess) {
  context_ = context_.with_threads(8);
  const double without_motion =
      plan_of(sequence_, options_, context_).bytes - motion_bytes(sequence_);
  int threads = 8;
  for (const double less : {0.1, 0.2, 0.3, 0.4}) {
    // Each thread holds two of 79 blocks.
    const double allowed = without_motion - less * 8 * 2 / 79 * motion_bytes(sequence_);
    const DecompositionPlan plan = plan_of(sequence_, options_, context_.with_memory(allowed));
    EXPECT_LE(plan.threads, threads);
    threads = plan.threads;
  }
  EXPECT_LT(threads, 8);
}

TEST_F(MemoryTest, IsRefusedWhereItHoldsNotOneBlock) {
  EXPECT_THAT([this] { decompose(sequence_, options_, context_.with_memory(1e6)); },
              ThrowsMessage<MismatchError>(
                  AllOf(HasSubstr("option 'memory': what is left of it, 1 MB, does not hold a "
                                  "decomposition of 24 frames into 4 components; allow at least"),
                        HasSubstr("take fewer components or frames"))));
}

}  // namespace
}  // namespace mimetra::test
