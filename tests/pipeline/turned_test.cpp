// Turning, moving, resizing or renumbering what is transferred changes nothing but that.

#include <numeric>
#include <random>

#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"

namespace mimetra {
namespace {

using test::frames_of;

/// A permutation of 0 .. count - 1.
std::vector<int> shuffled(int count, std::mt19937& random) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::ranges::shuffle(order, random);
  return order;
}

/// Source and target with other numbers of vertices and faces, whose corners begin elsewhere.
class Renumbering {
 public:
  Renumbering(const Triangles& triangles, int vertices, unsigned seed) {
    std::mt19937 random(seed);
    order_ = shuffled(vertices, random);
    std::vector<int> number(vertices);
    for (int v = 0; v < vertices; ++v) number[order_[v]] = v;
    const std::vector<int> faces = shuffled(static_cast<int>(triangles.rows()), random);
    Triangles renumbered(triangles.rows(), 3);
    for (int t = 0; t < triangles.rows(); ++t) {
      const auto first = static_cast<int>(random() % 3);
      for (int c = 0; c < 3; ++c) {
        renumbered(t, c) = number[triangles(faces[t], (first + c) % 3)];
      }
    }
    connectivity_ =
        std::make_shared<Connectivity>(Connectivity::from_triangles(vertices, renumbered));
  }

  /// Three columns a vertex (R x 3N).
  Frames of(const Frames& rows) const {
    Frames result(rows.rows(), rows.cols());
    for (std::size_t v = 0; v < order_.size(); ++v) {
      result.middleCols<3>(3 * static_cast<Eigen::Index>(v)) = rows.middleCols<3>(3 * order_[v]);
    }
    return result;
  }
  Positions of(const Positions& positions) const { return positions(order_, Eigen::all); }
  MeshSequence of(const MeshSequence& sequence) const {
    return {connectivity_, of(sequence.positions()), sequence.times(), of(sequence.rest())};
  }
  BlendshapeModel of(const BlendshapeModel& model) const {
    ShapeBasis expressions = model.expressions();
    expressions.displacements = of(Frames(expressions.displacements.transpose())).transpose();
    return {connectivity_, of(model.neutral()), std::move(expressions)};
  }
  /// Vertices as they were numbered before, ascending.
  std::vector<VertexIndex> before(std::vector<VertexIndex> vertices) const {
    for (VertexIndex& vertex : vertices) vertex = order_[vertex];
    std::ranges::sort(vertices);
    return vertices;
  }

 private:
  std::vector<int> order_;
  std::shared_ptr<const Connectivity> connectivity_;
};

/// A performance whose motion has no symmetry, so that nothing ties.
class TurnedTest : public testing::Test {
 protected:
  static constexpr int kFrames = 12;

  const test::Shape shape_ = test::patch();
  const BlendshapeModel actor_ = test::model_on(test::bent_patch(), 6);
  const BlendshapeModel mesh_{actor_.shared_connectivity(),
                              actor_.neutral(),
                              {{}, Eigen::MatrixXd(3 * actor_.vertices(), 0)}};

  static MeshSequence source(unsigned seed) {
    return test::model_on(test::patch(), 6).animate(test::random_weights(kFrames, 6, seed));
  }
  static TransferOptions by_regions() {
    return {.analysis = {.count = 4}, .regions = {.radius = Length::share(0.2)}};
  }
  static TransferResult onto(const MeshSequence& source, const BlendshapeModel& target,
                             const TransferOptions& options) {
    return transfer(source, {{"actor", target}}, options);
  }
  double size() const { return diameter(actor_.neutral()); }
};

TEST_F(TurnedTest, NumbersOfVerticesFacesAndCornersDoNotMatter) {
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const MeshSequence source = this->source(seed);
    const Renumbering renumbering(source.triangles(), source.vertices(), seed);
    for (const bool full : {false, true}) {
      TransferOptions options = by_regions();
      options.full = full;
      for (const BlendshapeModel& target : {actor_, mesh_}) {
        const TransferResult one = onto(source, target, options);
        const TransferResult other = onto(renumbering.of(source), renumbering.of(target), options);
        const Frames expected = renumbering.of(frames_of(one.targets[0].solution.sequence));
        EXPECT_LT((frames_of(other.targets[0].solution.sequence) - expected).cwiseAbs().maxCoeff(),
                  1e-9 * size());
        const double error = one.targets[0].error.de_all;
        EXPECT_NEAR(other.targets[0].error.de_all, error, 1e-9 * error);
        if (full) continue;
        ASSERT_EQ(other.regions->regions.size(), one.regions->regions.size());
        for (std::size_t k = 0; k < one.regions->regions.size(); ++k) {
          EXPECT_EQ(renumbering.before(other.regions->regions[k].vertices),
                    one.regions->regions[k].vertices);
        }
      }
    }
  }
}

TEST_F(TurnedTest, RegionsHoldTheSameVertices) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const MeshSequence source = this->source(seed);
    const Eigen::Vector3d axis(normal(random), normal(random), normal(random));
    const RigidTransform motion{
        Eigen::AngleAxisd(2 * normal(random), axis.normalized()).toRotationMatrix(),
        10 * size() * Eigen::Vector3d(normal(random), normal(random), normal(random))};
    const MeshSequence turned =
        with_motion(source, std::vector<RigidTransform>(source.frames(), motion))
            .with_rest(motion.apply(source.rest()));
    const TransferResult one = onto(source, actor_, by_regions());
    const TransferResult other = onto(turned, actor_, by_regions());
    ASSERT_EQ(other.regions->regions.size(), one.regions->regions.size());
    for (std::size_t k = 0; k < one.regions->regions.size(); ++k) {
      EXPECT_EQ(other.regions->regions[k].vertices, one.regions->regions[k].vertices);
    }
    EXPECT_LT((frames_of(other.targets[0].solution.sequence) -
               frames_of(one.targets[0].solution.sequence))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-9 * size());
  }
}

}  // namespace
}  // namespace mimetra
