#include "toolkit/report/viewer_data.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkBase64Utilities.h>
#include <vtkNew.h>
#include <vtkZLibDataCompressor.h>
#include <nlohmann/json.hpp>

#include "tests/shapes.h"

namespace mimetra {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// A grid that swings along z, a wave further each frame, far from the origin.
MeshSequence swinging(int frames, double seconds, int side = 12) {
  const test::Shape shape = test::grid(side, side);
  const Positions rest = shape.positions.rowwise() + Eigen::RowVector3d(100, -50, 7);
  Frames positions(frames, rest.size());
  Eigen::VectorXd times(frames);
  for (int f = 0; f < frames; ++f) {
    Positions pose = rest;
    for (int v = 0; v < pose.rows(); ++v) pose(v, 2) += std::sin(0.7 * v + 0.3 * f);
    positions.row(f) = Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size());
    times[f] = 2 + f * seconds / frames;
  }
  const auto n = static_cast<int>(rest.rows());
  return MeshSequence(Connectivity::from_triangles(n, shape.triangles), positions, times, rest);
}

/// The same with noise, so that no frame follows from others.
MeshSequence restless(int frames, double seconds, int side = 12) {
  const MeshSequence smooth = swinging(frames, seconds, side);
  Frames positions = smooth.positions();
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.1);
  for (double& number : positions.reshaped()) number += noise(random);
  return smooth.with_frames(std::move(positions));
}

ViewerScene scene_of(const MeshSequence& sequence) {
  std::vector<int> regions(static_cast<std::size_t>(sequence.vertices()), -1);
  regions[3] = 0;
  regions[4] = 1;
  ViewerScene scene;
  scene.meshes = {{"source", "take </script> & co", sequence, regions},
                  {"target", "actor", sequence, regions}};
  return scene;
}

constexpr std::size_t kPlenty = 5'000'000;

std::vector<unsigned char> inflated(const std::string& text, std::size_t size) {
  std::vector<unsigned char> packed(text.size());
  packed.resize(
      vtkBase64Utilities::DecodeSafely(reinterpret_cast<const unsigned char*>(text.data()),
                                       text.size(), packed.data(), packed.size()));
  std::vector<unsigned char> bytes(size);
  vtkNew<vtkZLibDataCompressor> compressor;
  EXPECT_EQ(compressor->Uncompress(packed.data(), packed.size(), bytes.data(), size), size);
  return bytes;
}

std::vector<int> indices(const json& text, std::size_t count) {
  const auto bytes = inflated(text.get<std::string>(), 4 * count);
  std::vector<int> result;
  unsigned sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (unsigned byte = 0; byte < 4; ++byte) sum += unsigned{bytes[4 * i + byte]} << (8 * byte);
    result.push_back(static_cast<int>(sum));
  }
  return result;
}

/// Rows of 16-bit numbers, or of differences from the row before, as a browser unpacks them.
Eigen::MatrixXd rows_in(const json& text, int rows, int width, bool differs) {
  const auto bytes = inflated(text.get<std::string>(),
                              2 * static_cast<std::size_t>(rows) * static_cast<std::size_t>(width));
  Eigen::MatrixXd result(rows, width);
  for (int f = 0; f < rows; ++f) {
    const unsigned char* row = bytes.data() + 2 * f * width;
    for (int i = 0; i < width; ++i) {
      const auto number = static_cast<std::int16_t>(row[i] | (row[width + i] << 8));
      const int before = differs && f > 0 ? static_cast<int>(result(f - 1, i)) : 0;
      result(f, i) = static_cast<std::int16_t>(before + number);  // as an Int16Array wraps
    }
  }
  return result;
}

TEST(ViewerData, HoldsEveryPositionWithinHalfAStep) {
  const MeshSequence sequence = restless(9, 0.3);
  const PackedScene scene = packed(scene_of(sequence), kPlenty);
  ASSERT_EQ(scene.frames, 9);
  const json mesh = json::parse(scene.json).at("meshes").at(1);
  const double step = mesh.at("step").get<double>();
  const Eigen::RowVector3d center(105.5, -44.5, 7);
  // From the centre of the rest pose to the farthest coordinate of all.
  double reach = 5.5;
  for (int f = 0; f < 9; ++f) {
    const Positions from_center = sequence.frame(f).rowwise() - center;
    reach = std::max(reach, from_center.cwiseAbs().maxCoeff());
  }
  EXPECT_NEAR(step, reach / kMostSteps, 1e-9);
  const Eigen::MatrixXd poses = rows_in(mesh.at("poses"), 10, 3 * sequence.vertices(), true);
  for (int f = 0; f < 10; ++f) {
    const Positions pose = f == 0 ? sequence.rest() : Positions(sequence.frame(f - 1));
    for (int i = 0; i < pose.size(); ++i) {
      const double shown = step * poses(f, i) + center[i % 3];
      ASSERT_NEAR(shown, pose.data()[i], (0.5 + 1e-6) * step) << "pose " << f << ", " << i;
    }
  }
}

TEST(ViewerData, HoldsMixturesOfFewPosesAndWhereTheyAreOff) {
  const MeshSequence smooth = swinging(40, 2);
  Frames frames = smooth.positions();
  // Some steps that follow from nothing, too few to be worth a pose of their own.
  frames(4, 7) += 0.01;
  frames(31, 100) -= 0.02;
  const MeshSequence sequence = smooth.with_frames(frames);
  const json mesh = json::parse(packed(scene_of(sequence), kPlenty).json).at("meshes").at(1);
  const double step = mesh.at("step").get<double>();
  const int width = 3 * sequence.vertices(), size = mesh.at("basisSize").get<int>();
  const Eigen::MatrixXd basis = rows_in(mesh.at("basis"), size, width, false),
                        weights = rows_in(mesh.at("weights"), 40, size, true);
  Eigen::MatrixXd shown = mesh.at("basisStep").get<double>() * weights * basis;
  shown.rowwise() +=
      rows_in(mesh.at("rest"), 1, width, false).row(0) / mesh.at("stepsOfRest").get<double>();
  const Eigen::RowVectorXd center = Eigen::RowVector3d(105.5, -44.5, 7).replicate(1, width / 3);
  Eigen::MatrixXd missed = ((sequence.positions().rowwise() - center) / step) - shown;

  std::vector<int> places;
  for (int f = 0; f < 40; ++f) {
    for (int i = 0; i < width; ++i) {
      if (std::abs(missed(f, i)) > 1) places.push_back(f * width + i);
    }
  }
  ASSERT_FALSE(places.empty());
  EXPECT_EQ(indices(mesh.at("correctedPlaces"), places.size()), places);
  const std::vector<int> corrections = indices(mesh.at("corrections"), places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    missed(places[i] / width, places[i] % width) -= corrections[i];
  }
  EXPECT_LE(missed.cwiseAbs().maxCoeff(), 1 + 1e-9);
}

TEST(ViewerData, HasAllFramesOfALongTakeThatAreMixtures) {
  const MeshSequence sequence = swinging(4000, 160);
  const PackedScene scene = packed(scene_of(sequence), 200'000);
  EXPECT_EQ(scene.frames, 4000);
  EXPECT_LE(scene.json.size(), 200'000U);
  EXPECT_EQ(json::parse(scene.json).at("times").size(), 4000U);
}

TEST(ViewerData, HoldsTrianglesAndRegionsAsTheyAre) {
  const MeshSequence sequence = swinging(3, 0.1);
  const ViewerScene scene = scene_of(sequence);
  const json data = json::parse(packed(scene, kPlenty).json);
  ASSERT_EQ(data.at("surfaces").size(), 1u);
  const json surface = data.at("surfaces").at(0);
  const auto triangles = indices(surface.at("triangles"), sequence.triangles().size());
  const Triangles& expected = sequence.triangles();
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    ASSERT_EQ(triangles[i], expected(static_cast<int>(i) / 3, static_cast<int>(i) % 3));
  }
  const std::vector<int>& regions = scene.meshes.front().regions;
  EXPECT_EQ(indices(surface.at("regions"), regions.size()), regions);
  EXPECT_EQ(data.at("regionColors").size(), 2u);
  EXPECT_NE(data.at("regionColors").at(0), data.at("clay"));
}

TEST(ViewerData, HoldsASurfaceForEachSetOfFaces) {
  const MeshSequence take = swinging(3, 0.1), other = swinging(3, 0.1, 5);
  ViewerScene scene = scene_of(take);
  scene.meshes.push_back({"target", "other", other, std::vector<int>(25, 1)});
  const json data = json::parse(packed(scene, kPlenty).json);
  ASSERT_EQ(data.at("surfaces").size(), 2u);
  EXPECT_EQ(data.at("surfaces").at(1).at("vertices"), 25);
  EXPECT_EQ(indices(data.at("surfaces").at(1).at("regions"), 25), std::vector<int>(25, 1));
  EXPECT_EQ(data.at("meshes").at(1).at("surface"), 0);
  EXPECT_EQ(data.at("meshes").at(2).at("surface"), 1);
}

TEST(ViewerData, ShadesVerticesAtOnePlaceAsOne) {
  Positions rest(4, 3);
  rest << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0;
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 0, 3, 2;
  Frames frames(2, 12);
  for (int f = 0; f < 2; ++f) {
    frames.row(f) = (1 + f) * Eigen::Map<const Eigen::RowVectorXd>(rest.data(), 12);
  }
  const MeshSequence sequence(Connectivity::from_triangles(4, triangles), frames, {}, rest);
  ViewerScene scene;
  scene.meshes = {{"source", "seam", sequence, {-1, -1, -1, -1}}};
  const json data = json::parse(packed(scene, kPlenty).json);
  EXPECT_THAT(indices(data.at("surfaces").at(0).at("places"), 4), ElementsAre(0, 1, 2, 1));
}

TEST(ViewerData, TellsTheLargestDisplacementOfAllFrames) {
  const MeshSequence sequence = swinging(40, 1);
  const json data = json::parse(packed(scene_of(sequence), kPlenty).json);
  double largest = 0;
  for (int f = 0; f < 40; ++f) {
    largest = std::max(largest, (sequence.frame(f) - sequence.rest()).cwiseAbs().maxCoeff());
  }
  EXPECT_DOUBLE_EQ(data.at("largest").get<double>(), largest);
}

TEST(ViewerData, ThinsEvenlyAndKeepsBothEnds) {
  EXPECT_THAT(thinned(10, 4), ElementsAre(0, 3, 6, 9));
  EXPECT_THAT(thinned(11, 3), ElementsAre(0, 5, 10));
  EXPECT_THAT(thinned(3, 8), ElementsAre(0, 1, 2));
  EXPECT_THAT(thinned(1, 2), ElementsAre(0));
}

TEST(ViewerData, ThinsFramesUntilTheyFit) {
  const MeshSequence sequence = restless(100, 4, 30);
  const std::size_t all = packed(scene_of(sequence), kPlenty).json.size();
  const PackedScene half = packed(scene_of(sequence), all / 2);
  EXPECT_LE(half.json.size(), all / 2);
  // Fewer frames differ more from each other: their sizes are estimated, and cut twice here.
  EXPECT_GT(half.json.size(), 0.7 * (all / 2.0));
  EXPECT_LT(half.frames, 100);
  const json times = json::parse(half.json).at("times");
  EXPECT_EQ(times.size(), static_cast<std::size_t>(half.frames));
  EXPECT_DOUBLE_EQ(times.front().get<double>(), sequence.times()[0]);
  EXPECT_DOUBLE_EQ(times.back().get<double>(), sequence.times()[99]);
}

TEST(ViewerData, HasNoMoreThanThirtyWholeFramesASecond) {
  EXPECT_EQ(packed(scene_of(swinging(120, 2)), kPlenty).frames, 120);
  EXPECT_EQ(packed(scene_of(restless(120, 2)), kPlenty).frames, 61);
}

TEST(ViewerData, IsEmptyWhereNotEvenTwoFramesFit) {
  const PackedScene scene = packed(scene_of(swinging(20, 1)), 500);
  EXPECT_TRUE(scene.json.empty());
  EXPECT_EQ(scene.frames, 0);
}

TEST(ViewerData, CannotEndTheScriptElementItStandsIn) {
  const std::string text = packed(scene_of(swinging(3, 0.1)), kPlenty).json;
  EXPECT_THAT(text, Not(HasSubstr("<")));
  EXPECT_EQ(json::parse(text).at("meshes").at(0).at("name"), "take </script> & co");
}

}  // namespace
}  // namespace mimetra
