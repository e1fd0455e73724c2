// Markers of real faces, which are sound, and what becomes of them where they are not.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shared_data.h"
#include "toolkit/correspondence/markers.h"
#include "toolkit/io/landmark_vertices.h"
#include "toolkit/io/marker_file.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::IsEmpty;

namespace fs = std::filesystem;

struct MarkedPair {
  TriMesh source, target;
  std::vector<Marker> markers;
};

MarkedPair by_hand(const std::string& source, const std::string& target, const std::string& name) {
  const fs::path markers = test::source_folder() / "samples" / "markers" / name;
  return {read_mesh(test::shared_path("data/" + source + "/neutral.obj")),
          read_mesh(test::shared_path("data/" + target + "/neutral.obj")), read_markers(markers)};
}

std::vector<MarkedPair> pairs_of_two_faces() {
  return {by_hand("facecap", "ict-face", "facecap_to_ict_face.markers"),
          by_hand("ict-face", "facecap", "ict_face_to_facecap.markers")};
}

std::vector<MarkedPair> sound_pairs() {
  std::vector<MarkedPair> pairs = pairs_of_two_faces();
  const fs::path folder = test::shared_path("data/ict-face");
  std::vector<Marker> landmarks;
  for (const auto& [number, vertex] :
       ibug_landmarks(read_landmark_mapping(folder / "landmarks68.txt"))) {
    landmarks.push_back({vertex, vertex});
  }
  const TriMesh neutral = read_mesh(folder / "neutral.obj");
  for (int identity = 0; identity < 10; ++identity) {
    const std::string name = "identity00" + std::to_string(identity) + ".obj";
    TriMesh other = read_mesh(folder / "identities" / name);
    other.positions = neutral.positions + 2 * (other.positions - neutral.positions);
    pairs.push_back({neutral, other, landmarks});
  }
  return pairs;
}

class SoundMarkers : public testing::Test {
 protected:
  void SetUp() override {
    MIMETRA_SKIP_WITHOUT(test::shared_path("data/facecap/neutral.obj"));
    MIMETRA_SKIP_WITHOUT(test::shared_path("data/ict-face/neutral.obj"));
  }
};

TEST_F(SoundMarkers, AreNotDoubtedOrRefused) {
  for (const auto& [source, target, markers] : sound_pairs()) {
    EXPECT_THAT(described(doubtful_markers(markers, source.positions, target.positions), markers),
                IsEmpty());
    EXPECT_FALSE(is_inside_out(source, target, markers));
    for (const int shift : {1, -1}) {
      EXPECT_FALSE(fit_better_shifted(markers, shift, source.positions, target.positions));
    }
  }
}

TEST_F(SoundMarkers, TellATargetThatIsInsideOutAndAreRefusedOnAMirroredOne) {
  for (auto& [source, target, markers] : sound_pairs()) {
    TriMesh inside_out = target;
    inside_out.connectivity.triangles.col(1).swap(inside_out.connectivity.triangles.col(2));
    EXPECT_TRUE(is_inside_out(source, inside_out, markers));
    target.positions.col(0) *= -1;
    target.connectivity = Connectivity::from_triangles(target.connectivity.vertices,
                                                       inside_out.connectivity.triangles);
    EXPECT_THROW(is_inside_out(source, target, markers), MismatchError);
  }
}

TEST_F(SoundMarkers, TellEachTwoOfThemThatAreExchanged) {
  const auto [source, target, markers] = pairs_of_two_faces().front();
  for (std::size_t i = 0; i < markers.size(); ++i) {
    for (std::size_t j = i + 1; j < markers.size(); ++j) {
      std::vector<Marker> exchanged = markers;
      std::swap(exchanged[i].target, exchanged[j].target);
      const auto doubtful = doubtful_markers(exchanged, source.positions, target.positions);
      ASSERT_EQ(doubtful.size(), 2U) << i << ' ' << j;
      EXPECT_EQ(doubtful[0].marker, i);
      EXPECT_EQ(doubtful[0].exchanged_with, j);
    }
  }
}

TEST_F(SoundMarkers, AreToldFromThoseOfAnotherBaseWhereFacesDiffer) {
  for (auto& [source, target, markers] : pairs_of_two_faces()) {
    for (Marker& marker : markers) marker = {marker.source + 1, marker.target + 1};
    EXPECT_TRUE(fit_better_shifted(markers, 1, source.positions, target.positions));
  }
}

}  // namespace
}  // namespace mimetra
