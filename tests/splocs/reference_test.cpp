#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>

#include <gmock/gmock.h>

#include "tests/npy.h"
#include "tests/shared_data.h"
#include "toolkit/splocs/decomposition.h"
#include "toolkit/splocs/start.h"

/// The decomposition against what the reference implementation gave for the same sequence and the
/// same distances.
namespace mimetra::test {
namespace {

// What the reference's own accumulated rounding, and dividing by a maximum, leave.
constexpr double kAgreement = 1e-6;

Frames as_matrix(const NpyArray& array) {
  return Eigen::Map<const Frames>(array.values.data(), array.rows(), array.columns());
}

class ReferenceDecomposition : public testing::Test {
 protected:
  void SetUp() override {
    MIMETRA_SKIP_WITHOUT(folder_);
    const Frames frames = as_matrix(read("verts"));
    const int vertices = static_cast<int>(frames.cols() / 3);
    sequence_ = MeshSequence(
        Connectivity::from_triangles(vertices, as_matrix(read("tris")).cast<int>()), frames);
    const NpyArray sources = read("distance_vertices");
    const Frames distances = as_matrix(read("distances"));
    std::map<VertexIndex, Eigen::VectorXd> of_vertex;
    for (int i = 0; i < sources.rows(); ++i) {
      of_vertex[static_cast<VertexIndex>(sources.values[i])] = distances.row(i);
    }
    options_.count = static_cast<int>(parameter("K"));
    options_.d_min = parameter("d_min");
    options_.d_max = parameter("d_max");
    options_.sparsity = parameter("lambda");
    options_.rho = parameter("rho");
    options_.iterations = static_cast<int>(parameter("iterations"));
    options_.admm_iterations = static_cast<int>(parameter("admm_iterations"));
    options_.tolerance = 0;
    options_.sign_rule = SignRule::literal;
    options_.scale = MotionScale::standard_deviation;
    options_.returned = ReturnedIterate::last;
    // A vertex that the reference never visited has no distances here: at() throws.
    from_vertex_ = [of_vertex](VertexIndex source) { return of_vertex.at(source); };
    options_.distances = one_by_one(from_vertex_);
  }

  NpyArray read(const std::string& name) const { return read_npy(folder_ / (name + ".npy")); }

  /// Numbers after a key of run.json: one, or a list.
  std::vector<double> numbers(const std::string& key) const {
    std::ifstream file(folder_ / "run.json");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const std::string quoted = '"' + key + "\":";
    std::istringstream list(text.substr(text.find(quoted) + quoted.size()));
    if ((list >> std::ws).peek() == '[') list.ignore();
    std::vector<double> result;
    // Ends at the next key or at the bracket: neither is a number.
    for (double number = 0; list >> number; list.ignore(1)) result.push_back(number);
    return result;
  }
  double parameter(const std::string& key) const { return numbers(key).at(0); }

  const std::filesystem::path folder_ = shared_path("oracle/splocs");
  MeshSequence sequence_;
  std::function<Eigen::VectorXd(VertexIndex)> from_vertex_;
  DecompositionOptions options_;
};

TEST_F(ReferenceDecomposition, StartsAtTheSameCentersWithTheSameComponentsAndWeights) {
  const Eigen::Map<const Eigen::RowVectorXd> rest(sequence_.rest().data(), sequence_.rest().size());
  const Frames X = (sequence_.positions().rowwise() - rest) * parameter("pre_scale");
  const Start start = greedy_start(
      VertexBlocks<double>(X),
      support_function(options_.distances, sequence_.vertices(), *options_.d_min, *options_.d_max),
      options_);
  const NpyArray centers = read("centres_init");
  EXPECT_TRUE(std::ranges::equal(start.centers, centers.values));
  const Frames W = as_matrix(read("W_init")), C = as_matrix(read("C_init"));
  EXPECT_LT((start.weights - W).norm(), kAgreement * W.norm());
  // Unlike the final components, these are stored in units of the scaled motion.
  EXPECT_LT((start.components.frames() - C).norm(), kAgreement * C.norm());
}

TEST_F(ReferenceDecomposition, EndsWithTheSameEnergiesWeightsAndComponentsByTheSameCenters) {
  // Every visit of a new centre asks for its distances. Row i of centres_iter: the centres around
  // which iteration i + 1 put its support maps.
  std::vector<double> expected = read("centres_init").values;
  const Frames centers = as_matrix(read("centres_iter"));
  for (int i = 0; i < centers.rows(); ++i) {
    for (int k = 0; k < centers.cols(); ++k) {
      if (i == 0 || centers(i, k) != centers(i - 1, k)) expected.push_back(centers(i, k));
    }
  }
  std::vector<VertexIndex> visited;
  options_.distances = one_by_one([&visited, this](VertexIndex source) {
    visited.push_back(source);
    return from_vertex_(source);
  });
  const Components components = decompose(sequence_, options_);
  EXPECT_TRUE(std::ranges::equal(visited, expected)) << testing::PrintToString(visited);
  const std::vector<double> energies = numbers("energy");
  ASSERT_EQ(components.energies.size(), energies.size());
  for (std::size_t i = 0; i < energies.size(); ++i) {
    EXPECT_NEAR(components.energies[i], energies[i], kAgreement * energies[i]) << i;
  }
  const Frames W = as_matrix(read("W")), C = as_matrix(read("C"));
  EXPECT_LT((components.weights - W).norm(), kAgreement * W.norm());
  EXPECT_LT((components.displacements - C).norm(), kAgreement * C.norm());
  EXPECT_NEAR(components.scale * parameter("pre_scale"), 1, kAgreement);
}

}  // namespace
}  // namespace mimetra::test
