#include "toolkit/splocs/reduction.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <gmock/gmock.h>

#include "tests/cache_sizes.h"
#include "tests/thread_ranks.h"
#include "toolkit/mesh/rounding.h"

namespace mimetra::test {
namespace {

constexpr Eigen::Index kBlock = VertexPart::kBlock;

/// What runs give, and how two nodes are joined.
struct Tree {
  std::function<double(int run)> leaf;
  std::function<double(double left, double right)> join;
};

/// Sums that round differently in every order.
const Tree kSums = {[](int run) { return 1e6 / (2 * run + 3); }, std::plus<double>()};

/// A number that tells trees apart, of whole numbers without rounding: neither the halves of a node
/// nor the nodes that three runs can form are interchangeable.
const Tree kShapes = {
    [](int run) { return run + 1.0; },
    [](double left, double right) { return std::fmod(3 * left + 5 * right + 1, 999999937); }};

/// The node of `size` runs from `first` on, of a tree of `runs`, as the header describes it.
double literal_node(int first, int size, int runs, const Tree& tree) {
  if (size == 1) return tree.leaf(first);
  const double left = literal_node(first, size / 2, runs, tree);
  if (first + size / 2 >= runs) return left;
  return tree.join(left, literal_node(first + size / 2, size / 2, runs, tree));
}

double literal_root(int runs, const Tree& tree) {
  return literal_node(0, 64, runs, tree);
}

/// 0 x 0 but for the first rank.
Eigen::MatrixXd root_of(const Tree& tree, const Reduction& reduction) {
  return reduction.joined(
      1, 1, [&tree](int run, Eigen::MatrixXd& leaf) { leaf(0) = tree.leaf(run); },
      [&tree](Eigen::MatrixXd& left, const Eigen::MatrixXd& right) {
        left(0) = tree.join(left(0), right(0));
      });
}

/// One thread of a rank.
Context alone_in(const Ranks& rank) {
  return Context().with_threads(1).with_ranks(rank);
}

TEST(VertexPart, PartsOfAllRanksAreTheMesh) {
  for (Eigen::Index vertices = 1; vertices < 70 * kBlock; vertices += 101) {
    for (const int ranks : {1, 2, 3, 7, 64, 70}) {
      Eigen::Index next_vertex = 0;
      int next_run = 0;
      for (int rank = 0; rank < ranks; ++rank) {
        const VertexPart part(vertices, rank, ranks);
        if (part.vertices() == 0) continue;
        EXPECT_EQ(part.first(), next_vertex);
        EXPECT_EQ(part.runs().first, next_run);
        EXPECT_EQ(part.owner(static_cast<VertexIndex>(part.first())), rank);
        next_vertex += part.vertices();
        next_run += part.runs().count();
        EXPECT_EQ(part.owner(static_cast<VertexIndex>(next_vertex - 1)), rank);
        EXPECT_EQ(part.blocks_of(part.runs().first).first, 0);
        EXPECT_EQ(part.blocks_of(part.runs().end - 1).end, part.blocks());
      }
      EXPECT_EQ(next_vertex, vertices);
      EXPECT_EQ(next_run, std::min<Eigen::Index>(64, (vertices + kBlock - 1) / kBlock));
    }
  }
}

TEST(VertexPart, RunsDoNotDependOnRanks) {
  const VertexPart all(150 * kBlock);
  for (const int ranks : {2, 3, 5, 64}) {
    for (int rank = 0; rank < ranks; ++rank) {
      const VertexPart part(150 * kBlock, rank, ranks);
      const auto before = static_cast<int>(part.first() / kBlock);
      for (int run = part.runs().first; run < part.runs().end; ++run) {
        EXPECT_EQ(part.blocks_of(run).first + before, all.blocks_of(run).first);
        EXPECT_EQ(part.blocks_of(run).end + before, all.blocks_of(run).end);
      }
    }
  }
}

TEST(VertexPart, RefusesARankBeyondTheLast) {
  EXPECT_THROW(VertexPart(100, 2, 2), std::invalid_argument);
  EXPECT_THROW(VertexPart(100, -1, 2), std::invalid_argument);
}

TEST(Reduction, JoinsAlongOneTreeForEveryNumberOfRanksAndThreads) {
  for (int blocks = 1; blocks <= 200; ++blocks) {
    const double expected = literal_root(std::min(64, blocks), kShapes);
    for (const int threads : {1, 3}) {
      EXPECT_EQ(root_of(kShapes, Reduction(blocks * kBlock, Context().with_threads(threads)))(0),
                expected);
    }
    for (const int ranks : {2, 3, 4, 7}) {
      on_ranks(ranks, [&](const Ranks& rank) {
        const Context context = Context().with_threads(2).with_ranks(rank);
        const Eigen::MatrixXd root = root_of(kShapes, Reduction(blocks * kBlock, context));
        if (rank.rank() == 0) {
          EXPECT_EQ(root(0), expected) << blocks << " blocks on " << ranks;
        } else {
          EXPECT_EQ(root.size(), 0);
        }
      });
    }
  }
}

TEST(Reduction, GivesTheSameBitsWhereverRanksPartTheRuns) {
  // 50 runs: the last nodes of the tree are cut off. More ranks than runs leave some without any.
  const double expected = literal_root(50, kSums);
  for (int ranks = 1; ranks <= 53; ++ranks) {
    on_ranks(ranks, [&](const Ranks& rank) {
      const Reduction reduction(50 * kBlock, alone_in(rank));
      const Eigen::MatrixXd sum = reduction.everywhere(
          reduction.sum(1, 1, [](int run, Eigen::MatrixXd& leaf) { leaf(0) = kSums.leaf(run); }));
      EXPECT_EQ(sum(0), expected) << ranks << " ranks";
    });
  }
  // Another order of additions would have shown.
  double in_order = 0;
  for (int run = 0; run < 50; ++run) in_order += kSums.leaf(run);
  EXPECT_NE(in_order, expected);
}

TEST(Reduction, OfAPowerOfTwoRanksSendsOneMatrixEach) {
  for (const int ranks : {1, 2, 4, 8, 16}) {
    const Traffic sent = on_ranks(
        ranks, [](const Ranks& rank) { root_of(kShapes, Reduction(64 * kBlock, alone_in(rank))); });
    EXPECT_EQ(sent.messages, ranks - 1);
  }
}

TEST(Reduction, GivesAllRanksWhatOneHas) {
  on_ranks(3, [](const Ranks& rank) {
    const Reduction reduction(10 * kBlock, alone_in(rank));
    for (int from = 0; from < 3; ++from) {
      const Eigen::MatrixXd given = reduction.on(from, [&]() -> Eigen::MatrixXd {
        EXPECT_EQ(rank.rank(), from);
        return Eigen::MatrixXd::Constant(from + 1, 2, 0.1 * from);
      });
      EXPECT_TRUE(equal_bytes(given, Eigen::MatrixXd::Constant(from + 1, 2, 0.1 * from)));
    }
  });
}

TEST(Reduction, OfNoVerticesIsZero) {
  const Reduction reduction(0);
  const auto never = [](int, Eigen::MatrixXd&) { FAIL() << "there is no run"; };
  EXPECT_TRUE(equal_bytes(reduction.sum(2, 3, never), Eigen::MatrixXd::Zero(2, 3)));
  EXPECT_EQ(strongest_vertex(Eigen::VectorXd()), -1);
}

/// argmax of `values` (rows x N) on so many ranks, which all must have the same.
std::vector<VertexIndex> argmax_on(int ranks, const Eigen::MatrixXd& values, int threads = 1) {
  std::vector<std::vector<VertexIndex>> found(ranks);
  on_ranks(ranks, [&](const Ranks& rank) {
    const Reduction reduction(values.cols(), Context().with_threads(threads).with_ranks(rank));
    const VertexPart& part = reduction.part();
    found[rank.rank()] = reduction.argmax(static_cast<int>(values.rows()), [&](int b) {
      return Eigen::MatrixXd(values.middleCols(part.first() + part.first_of(b), part.size_of(b)));
    });
  });
  for (const auto& of_rank : found) EXPECT_EQ(of_rank, found.front());
  return found.front();
}

TEST(Argmax, OfTiesIsTheLowestVertexOfAllRanks) {
  Eigen::MatrixXd values = Eigen::MatrixXd::Constant(7, 12 * kBlock, 0.5);
  const auto last = static_cast<VertexIndex>(values.cols() - 1);
  // The first and the last; two beside a border of blocks; a tie up to rounding, also where the
  // larger is the later; a clear difference; everywhere; nowhere.
  values(0, 0) = values(0, last) = 3;
  values(1, kBlock - 1) = values(1, kBlock) = 3;
  values(2, 700) = 3;
  values(2, 1500) = 3 * (1 + 1e-12);
  values(3, 700) = 3 * (1 + 1e-12);
  values(3, 1500) = 3;
  values(4, 700) = 3;
  values(4, 1500) = 3 * (1 + 1e-8);
  values.row(6).setZero();
  for (const int ranks : {1, 2, 3, 4, 7, 12, 14}) {
    EXPECT_THAT(argmax_on(ranks, values),
                testing::ElementsAre(0, kBlock - 1, 700, 700, 1500, 0, -1));
  }
}

TEST(Argmax, OfAnyNumberOfThreadsAndRanksIsTheFirstThatTiesWithTheLargest) {
  // 80 blocks in 64 runs, so many rows that threads share the work. A few values tie.
  Eigen::MatrixXd values(70, 80 * kBlock - 5);
  std::mt19937 random(7);
  for (double& value : values.reshaped()) value = 1 + 2e-10 * static_cast<double>(random() % 20000);
  values.row(3) *= -1;
  values.row(4).setZero();
  std::vector<VertexIndex> expected;
  for (const auto& row : values.rowwise()) {
    const double largest = row.maxCoeff();
    VertexIndex v = largest > 0 ? 0 : -1;
    while (v >= 0 && row[v] < (1 - kNearTie) * largest) ++v;
    expected.push_back(v);
  }
  ASSERT_GT(*std::ranges::max_element(expected), 10 * kBlock);
  for (const int threads : {1, 2, 5}) EXPECT_EQ(argmax_on(1, values, threads), expected);
  EXPECT_EQ(argmax_on(3, values, 2), expected);
}

TEST(Argmax, AsksForTheValuesOfABlockOnce) {
  const Reduction reduction(80 * kBlock, Context().with_threads(1));
  std::vector<int> asked(80);
  // One row has no value above 0, the other its largest in every block.
  reduction.argmax(2, [&asked](int b) -> Eigen::MatrixXd {
    ++asked[b];
    return Eigen::Vector2d(0, 1).replicate(1, kBlock);
  });
  EXPECT_THAT(asked, testing::Each(1));
}

}  // namespace
}  // namespace mimetra::test
