#include <functional>
#include <limits>
#include <mutex>
#include <set>

#include <gmock/gmock.h>

#include "tests/cache_sizes.h"
#include "tests/splocs/synthetic.h"
#include "tests/thread_ranks.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/splocs/time_basis.h"

/// The decomposition on several ranks, each of which holds the poses of its own vertices only,
/// against the one on a single rank: the same bytes.
namespace mimetra::test {
namespace {

/// Poses of a part's vertices, F x 3n.
Frames frames_of(const VertexPart& part, const MeshSequence& sequence) {
  return sequence.positions().middleCols(3 * part.first(), 3 * part.vertices());
}

/// Vertices without faces that move so.
MeshSequence points_of(Frames frames) {
  const auto vertices = static_cast<int>(frames.cols() / 3);
  return {Connectivity::from_triangles(vertices, Triangles(0, 3)), std::move(frames)};
}

MeshSequence points_of(const VertexPart& part, const MeshSequence& sequence) {
  return points_of(frames_of(part, sequence));
}

/// What each rank returns.
std::vector<Components> decomposed_on(int ranks, const MeshSequence& sequence,
                                      const DecompositionOptions& options,
                                      const Context& context = {}) {
  std::vector<Components> parts(ranks);
  on_ranks(ranks, [&](const Ranks& rank) {
    const VertexPart part(sequence.vertices(), rank.rank(), ranks);
    const MeshSequence points = points_of(part, sequence);
    parts[rank.rank()] = decompose_part({sequence.rest(), sequence.triangles(), points}, options,
                                        context.with_ranks(rank));
  });
  return parts;
}

/// Side by side what each rank has of the rows of a matrix.
Eigen::MatrixXd side_by_side(const std::vector<Components>& parts,
                             const std::function<Eigen::MatrixXd(const Components&)>& rows) {
  Eigen::MatrixXd all(rows(parts.front()).rows(), 0);
  for (const Components& part : parts) {
    const Eigen::MatrixXd next = rows(part);
    all.conservativeResize(Eigen::NoChange, all.cols() + next.cols());
    all.rightCols(next.cols()) = next;
  }
  return all;
}

void expect_equal(const std::vector<Components>& parts, const Components& whole) {
  for (const Components& part : parts) {
    EXPECT_TRUE(equal_bytes(part.weights, whole.weights));
    EXPECT_EQ(part.centers, whole.centers);
    EXPECT_EQ(part.energies, whole.energies);
    EXPECT_EQ(part.iteration, whole.iteration);
    EXPECT_EQ(part.converged, whole.converged);
    EXPECT_EQ(part.scale, whole.scale);
    EXPECT_EQ(part.d_max, whole.d_max);
  }
  EXPECT_TRUE(equal_bytes(side_by_side(parts, [](const Components& c) { return c.displacements; }),
                          whole.displacements));
  EXPECT_TRUE(equal_bytes(side_by_side(parts, [](const Components& c) { return c.support; }),
                          whole.support));
}

/// By default on two ranks, each of which owns a complete node of the tree, and on three, which do
/// not. Returns the decomposition on one.
Components expect_equal_on_ranks(const MeshSequence& sequence, const DecompositionOptions& options,
                                 const std::vector<int>& numbers_of_ranks = {2, 3}) {
  Components whole = decompose(sequence, options);
  for (const int ranks : numbers_of_ranks) {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    expect_equal(decomposed_on(ranks, sequence, options), whole);
  }
  return whole;
}

/// 13 blocks of vertices, the last of them partial.
const MeshSequence& many_blocks() {
  static const MeshSequence sequence = restless_grid(60, 40, 20);
  return sequence;
}

TEST(Ranks, DecomposeToTheSameBytes) {
  const MeshSequence sequence = many_blocks();
  expect_equal_on_ranks(sequence, grid_options(sequence, 6), {1, 2, 3, 4, 7});
}

TEST(Ranks, DecomposeToTheSameBytesInSinglePrecision) {
  const MeshSequence sequence = many_blocks();
  DecompositionOptions options = grid_options(sequence, 6);
  options.precision = IterationPrecision::single_precision;
  expect_equal_on_ranks(sequence, options);
}

/// 60 frames of so many bumps on as many blocks.
MeshSequence moving_bumps(int count) {
  const Shape shape = grid(60, 40);
  Eigen::MatrixXd W(60, count);
  Frames C(count, shape.positions.size());
  for (int k = 0; k < count; ++k) {
    C.row(k) = bump(shape.positions, {10.0 + 17 * k, 8.0 + 11 * k, 0}, 9, {0.5 * k, 1, 1});
    for (int f = 0; f < 60; ++f) W(f, k) = 1 - std::cos(0.1 * (k + 1) * f);
  }
  return synthesised(shape, W, C);
}

TEST(Ranks, DecomposeToTheSameBytesInABasisOfTime) {
  const MeshSequence sequence = moving_bumps(3);
  DecompositionOptions options = grid_options(sequence, 3);
  options.basis_tolerance = 1e-4;
  options.iterations = 4;
  expect_equal_on_ranks(sequence, options);
  options.precision = IterationPrecision::single_precision;
  expect_equal_on_ranks(sequence, options);
}

TEST(Ranks, DecomposeToTheSameBytesWithPartsSignedWeightsAndTheReferencesRules) {
  const MeshSequence sequence = many_blocks();
  DecompositionOptions options = grid_options(sequence, 5);
  options.nonnegative = false;
  options.sign_rule = SignRule::literal;
  options.scale = MotionScale::standard_deviation;
  options.returned = ReturnedIterate::last;
  options.parts.weights = {1, 0.25};
  for (int v = 0; v < sequence.vertices(); ++v) options.parts.of_vertex.push_back(v % 60 < 20);
  expect_equal_on_ranks(sequence, options);
}

TEST(Ranks, DecomposeToTheSameBytesUntilItConverges) {
  const MeshSequence sequence = many_blocks();
  DecompositionOptions options = grid_options(sequence, 4);
  options.iterations = 60;
  options.tolerance = 1e-3;
  EXPECT_TRUE(*expect_equal_on_ranks(sequence, options).converged);
}

TEST(Ranks, DecomposeToTheSameBytesWithGeodesicDistancesOfEachRank) {
  const MeshSequence sequence = many_blocks();
  DecompositionOptions options = grid_options(sequence, 3);
  options.distances = nullptr;
  options.iterations = 3;
  // Each rank factors the whole mesh.
  expect_equal_on_ranks(sequence, options);
}

TEST(Ranks, DecomposeToTheSameBytesWithSeveralBlocksInARun) {
  // 79 blocks in 64 runs.
  const MeshSequence sequence = restless_grid(140, 108, 8);
  DecompositionOptions options = grid_options(sequence, 3);
  options.iterations = 3;
  expect_equal_on_ranks(sequence, options);
}

TEST(Ranks, OfAnyNumberOfThreadsDecomposeToTheSameBytes) {
  const MeshSequence sequence = many_blocks();
  const DecompositionOptions options = grid_options(sequence, 5);
  const Components whole = decompose(sequence, options, Context().with_threads(1));
  for (const int threads : {2, 5}) {
    const Context context = Context().with_threads(threads);
    expect_equal({decompose(sequence, options, context)}, whole);
    expect_equal(decomposed_on(2, sequence, options, context), whole);
  }
}

TEST(Ranks, SendInAnIterationWhatTheDocumentationSays) {
  // 64 runs, so that each of 2 or 4 ranks owns one complete node of the tree.
  const MeshSequence sequence = restless_grid(140, 108, 8);
  DecompositionOptions options = grid_options(sequence, 3);
  const auto numbers_in = [&](int ranks, int iterations) {
    options.iterations = iterations;
    return on_ranks(ranks,
                    [&](const Ranks& rank) {
                      const VertexPart part(sequence.vertices(), rank.rank(), ranks);
                      const MeshSequence points = points_of(part, sequence);
                      decompose_part({sequence.rest(), sequence.triangles(), points}, options,
                                     Context().with_ranks(rank));
                    })
        .numbers;
  };
  const std::size_t F = 8, K = 3;
  const std::size_t up = (F + K + 1) * K + 2 * K, down = K * (F + K) + 2 * K + 1 + 4 * 2;
  for (const std::size_t ranks : {2, 4}) {
    const auto count = static_cast<int>(ranks);
    EXPECT_EQ(numbers_in(count, 3) - numbers_in(count, 2), (ranks - 1) * (up + down));
  }
}

TEST(Ranks, MayOwnNothing) {
  const MeshSequence sequence = restless_grid(17, 16, 12);
  ASSERT_EQ(VertexPart(sequence.vertices(), 1, 7).vertices(), 0);
  DecompositionOptions options = grid_options(sequence, 4);
  options.basis_tolerance = 0.5;
  expect_equal_on_ranks(sequence, options, {7});
}

TEST(Ranks, LetComponentsDieAlike) {
  const MeshSequence sequence = moving_bumps(1);
  DecompositionOptions options = grid_options(sequence, 4);
  options.d_min = 100;
  options.d_max = 200;
  EXPECT_EQ(expect_equal_on_ranks(sequence, options).centers.back(), -1);
}

TEST(Ranks, MeasureTheSameError) {
  const MeshSequence sequence = many_blocks();
  DecompositionOptions options = grid_options(sequence, 6);
  options.iterations = 3;
  const DecompositionError whole = decomposition_error(sequence, decompose(sequence, options));
  ASSERT_GT(whole.rms, 0);
  ASSERT_GT(whole.sparsity, 0);
  for (const int ranks : {2, 3}) {
    on_ranks(ranks, [&](const Ranks& rank) {
      const Context context = Context().with_threads(1).with_ranks(rank);
      const MeshSequence points =
          points_of(VertexPart(sequence.vertices(), rank.rank(), ranks), sequence);
      const SequencePart part{sequence.rest(), sequence.triangles(), points};
      const DecompositionError error =
          decomposition_error(part, decompose_part(part, options, context), context);
      EXPECT_EQ(error.rms, whole.rms);
      EXPECT_EQ(error.relative_rms, whole.relative_rms);
      EXPECT_EQ(error.kg, whole.kg);
      EXPECT_EQ(error.sparsity, whole.sparsity);
    });
  }
}

TEST(Ranks, ReadTheirOwnVerticesOfASharedSequence) {
  const MeshSequence sequence = many_blocks();
  const DecompositionOptions options = grid_options(sequence, 6);
  const Components whole = decompose(sequence, options);
  const DecompositionError error = decomposition_error(sequence, whole);
  for (const int ranks : {2, 3}) {
    on_ranks(ranks, [&](const Ranks& rank) {
      const Context context = Context().with_ranks(rank);
      const Components found = decompose(sequence, options, context);
      EXPECT_TRUE(equal_bytes(found.displacements, whole.displacements));
      EXPECT_TRUE(equal_bytes(found.support, whole.support));
      EXPECT_TRUE(equal_bytes(found.weights, whole.weights));
      EXPECT_EQ(found.centers, whole.centers);
      EXPECT_EQ(found.energies, whole.energies);
      EXPECT_EQ(decomposition_error(sequence, found, context).rms, error.rms);
    });
  }
}

TEST(Ranks, ComputeEachDistanceOnce) {
  const MeshSequence sequence = many_blocks();
  DecompositionOptions options = grid_options(sequence, 6);
  std::mutex mutex;
  std::multiset<VertexIndex> alone, together;
  const auto counted = [&mutex, distances = options.distances](std::multiset<VertexIndex>& asked) {
    return [&mutex, &asked, distances](std::span<const VertexIndex> sources) {
      const std::lock_guard lock(mutex);
      asked.insert(sources.begin(), sources.end());
      return distances(sources);
    };
  };
  options.distances = counted(alone);
  decompose(sequence, options);
  options.distances = counted(together);
  on_ranks(3, [&](const Ranks& rank) { decompose(sequence, options, Context().with_ranks(rank)); });
  EXPECT_EQ(together, alone);
}

/// What one rank is given.
struct Given {
  Positions rest;
  Frames frames;
};

/// Messages of the errors of all ranks, where `change` has changed what they are given.
template <typename Error>
std::vector<std::string> messages_on(
    int ranks, const MeshSequence& sequence,
    const std::function<void(int rank, Given& given)>& change = [](int, Given&) {}) {
  std::vector<std::string> messages(ranks);
  on_ranks(ranks, [&](const Ranks& rank) {
    Given given{sequence.rest(),
                frames_of(VertexPart(sequence.vertices(), rank.rank(), ranks), sequence)};
    change(rank.rank(), given);
    try {
      decompose_part({given.rest, sequence.triangles(), points_of(given.frames)},
                     grid_options(sequence, 2), Context().with_ranks(rank));
    } catch (const Error& error) {
      messages[rank.rank()] = error.what();
    }
  });
  return messages;
}

TEST(Ranks, RefuseAStillMeshAlike) {
  const MeshSequence moving = many_blocks();
  const MeshSequence still =
      moving.with_frames(moving.positions().topRows(1).replicate(20, 1)).with_rest(moving.frame(0));
  EXPECT_THAT(messages_on<MismatchError>(3, still),
              testing::Each(testing::HasSubstr("nothing moves: all 20 frames")));
}

TEST(Ranks, RefuseWhatOneOfThemFindsInfiniteAlike) {
  const MeshSequence sequence = many_blocks();
  Frames frames = sequence.positions();
  frames(5, frames.cols() - 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(messages_on<std::invalid_argument>(3, sequence.with_frames(frames)),
              testing::Each("frame 5 has a coordinate that is not a finite number"));
  frames(5, frames.cols() - 1) = 1e200;
  EXPECT_THAT(messages_on<std::invalid_argument>(3, sequence.with_frames(frames)),
              testing::Each(testing::HasSubstr("frame 5 is so far from the rest pose")));
}

TEST(Ranks, RefuseTheVerticesOfOthersAlike) {
  const MeshSequence sequence = many_blocks();
  for (const int wrong : {0, 2}) {
    const auto give_all = [&](int rank, Given& given) {
      if (rank == wrong) given.frames = sequence.positions();
    };
    const VertexPart part(sequence.vertices(), wrong, 3);
    EXPECT_THAT(
        messages_on<std::invalid_argument>(3, sequence, give_all),
        testing::Each("rank " + std::to_string(wrong) + " has 7200 coordinates a frame, expected " +
                      std::to_string(3 * part.vertices())));
  }
}

TEST(Ranks, RefuseOtherNumbersOfFramesAlike) {
  const MeshSequence sequence = many_blocks();
  for (const int frames : {1, 19}) {
    const auto give_fewer = [frames](int rank, Given& given) {
      if (rank == 1) given.frames.conservativeResize(frames, Eigen::NoChange);
    };
    EXPECT_THAT(messages_on<std::invalid_argument>(3, sequence, give_fewer),
                testing::Each("rank 1 has " + std::to_string(frames) + " frames, expected 20"));
  }
  const auto give_one = [](int, Given& given) {
    given.frames.conservativeResize(1, Eigen::NoChange);
  };
  EXPECT_THAT(messages_on<MismatchError>(3, sequence, give_one),
              testing::Each(testing::HasSubstr("the sequence has one frame")));
}

TEST(Ranks, RefuseOtherFramesOfARankThatOwnsNothing) {
  const MeshSequence sequence = restless_grid(17, 16, 12);
  ASSERT_EQ(VertexPart(sequence.vertices(), 1, 7).vertices(), 0);
  const auto give_fewer = [](int rank, Given& given) {
    if (rank == 1) given.frames.resize(3, 0);
  };
  EXPECT_THAT(messages_on<std::invalid_argument>(7, sequence, give_fewer),
              testing::Each("rank 1 has 3 frames, expected 12"));
}

TEST(Ranks, RefuseOtherMeshesAlike) {
  const MeshSequence sequence = many_blocks();
  const auto give_smaller = [](int rank, Given& given) {
    if (rank == 2) given.rest.conservativeResize(300, 3);
  };
  EXPECT_THAT(messages_on<std::invalid_argument>(3, sequence, give_smaller),
              testing::Each("rank 2 has 300 vertices in its mesh, expected 2400"));
  const auto give_infinite = [](int rank, Given& given) {
    if (rank == 2) given.rest(5, 1) = std::numeric_limits<double>::infinity();
  };
  EXPECT_THAT(messages_on<std::invalid_argument>(3, sequence, give_infinite),
              testing::Each("the rest pose has a coordinate that is not a finite number"));
}

TEST(Ranks, FindTheSameBasisOfTime) {
  const MeshSequence sequence = many_blocks();
  const Frames X = sequence.positions();
  const auto whole = time_basis(VertexBlocks<double>(X), X.squaredNorm(), 0.1, X.rows());
  ASSERT_TRUE(whole);
  on_ranks(3, [&](const Ranks& rank) {
    const VertexPart part(sequence.vertices(), rank.rank(), 3);
    VertexBlocks<double> own(X.rows(), part);
    const VertexBlocks<double> all(X);
    for (int b = 0; b < own.count(); ++b) {
      own[b] = all[b + static_cast<int>(part.first() / VertexPart::kBlock)];
    }
    const auto basis =
        time_basis(own, X.squaredNorm(), 0.1, X.rows(), Context().with_threads(1).with_ranks(rank));
    ASSERT_TRUE(basis);
    EXPECT_TRUE(equal_bytes(basis->Q, whole->Q));
    EXPECT_TRUE(equal_bytes(basis->B.frames(),
                            whole->B.frames().middleCols(3 * part.first(), 3 * part.vertices())));
  });
}

}  // namespace
}  // namespace mimetra::test
